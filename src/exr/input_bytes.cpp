#include "exr/input_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace varve {

InputBytes::InputBytes(const std::string& path) : path_(path) {
  do {
    // Not blocking: a named pipe is refused below instead of waiting for a writer.
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  } while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ < 0)
    throw Failure(ExitCode::input,
                  "cannot open '" + path + "': " + std::strerror(errno) +
                      (errno == ENOENT ? "; check the name, or leave the frame out with --frames" : ""));
  measure();
}

InputBytes::InputBytes(int descriptor, const std::string& path) : path_(path), descriptor_(descriptor) { measure(); }

InputBytes::InputBytes(InputBytes&& other) noexcept
    : path_(std::move(other.path_)), size_(other.size_), descriptor_(std::exchange(other.descriptor_, -1)) {}

InputBytes& InputBytes::operator=(InputBytes&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(size_, other.size_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

InputBytes::~InputBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void InputBytes::measure() {
  struct stat status {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    ::close(std::exchange(descriptor_, -1));
    throw Failure(ExitCode::input, "'" + path_ + "' is not a regular file");
  }
  size_ = std::uint64_t(status.st_size);
}

std::size_t InputBytes::read_some(std::uint64_t offset, void* to, std::size_t count) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t n = ::pread(descriptor_, static_cast<char*>(to) + done, count - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Failure(ExitCode::input, "cannot read '" + path_ + "': " + std::strerror(errno));
    if (n == 0) break;
    done += std::size_t(n);
  }
  return done;
}

void InputBytes::read(std::uint64_t offset, void* to, std::size_t count, const char* what) const {
  const bool inside = offset <= size_ && count <= size_ - offset;
  if (!inside || read_some(offset, to, count) != count)
    throw Failure(ExitCode::input, "'" + path_ + "' is cut off in its " + what + "; render or copy it again");
}

}  // namespace varve
