#include "exr/output_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "exr/write_frame.h"

namespace varve {
namespace {

std::string folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

const char* remedy(int reason) {
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space or choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a folder you may write to";
    case ENOENT:
    case ENOTDIR:
      return "; create the folder first";
    default:
      return "; choose another folder";
  }
}

}  // namespace

OutputBytes::OutputBytes(const std::string& path) : path_(path), folder_(folder_of(path)) {
  const std::string stem =
      folder_ + "/." + std::filesystem::path(path).filename().string() + ".varve-" + std::to_string(::getpid());
  // The number tells writers of one process apart; it is also what a crashed process of the same id may have left.
  for (int n = 0; descriptor_ < 0; ++n) {
    temporary_ = stem + "-" + std::to_string(n) + ".tmp";
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EINTR && (errno != EEXIST || n >= 1000)) {
      const int reason = errno;
      temporary_.clear();
      fail("create", reason);
    }
  }
}

OutputBytes::~OutputBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputBytes::fail(const char* action, int reason) const {
  throw Failure(ExitCode::output,
                std::string("cannot ") + action + " '" + path_ + "': " + std::strerror(reason) + remedy(reason));
}

void OutputBytes::write_at(std::uint64_t offset, const void* bytes, std::size_t count) {
  const char* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t n = ::pwrite(descriptor_, from, count, off_t(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("write", n < 0 ? errno : ENOSPC);
    from += n;
    offset += std::uint64_t(n);
    count -= std::size_t(n);
  }
}

void OutputBytes::append(const void* bytes, std::size_t count) {
  write_at(size_, bytes, count);
  size_ += count;
}

void OutputBytes::overwrite(std::uint64_t offset, const void* bytes, std::size_t count) {
  write_at(offset, bytes, count);
}

void OutputBytes::commit() {
  if (::fsync(descriptor_) != 0) fail("write", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("write", errno);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("create", errno);
  temporary_.clear();
  // The name itself is safe only once the folder is on disk. Some file systems cannot flush folders; that is no reason
  // to call a complete file a failure.
  const int folder = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

void check_writable(const std::string& path) {
  const std::string folder = folder_of(path);
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode))
    throw Failure(ExitCode::output, "'" + path + "' is a folder; give the name of a file");
  // A name is taken by renaming: that would replace the device or pipe itself.
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Failure(ExitCode::output, "'" + path + "' is a device or a pipe; give the name of a file");
  if (std::filesystem::path(path).filename().empty())
    throw Failure(ExitCode::output, "'" + path + "' is no file name; give the name of a file");
  if (::stat(folder.c_str(), &status) != 0)
    throw Failure(ExitCode::output,
                  "the folder '" + folder + "' cannot be used: " + std::strerror(errno) + remedy(errno));
  if (!S_ISDIR(status.st_mode))
    throw Failure(ExitCode::output, "'" + folder + "' is a file, not a folder; choose another output name");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Failure(ExitCode::output,
                  "the folder '" + folder + "' cannot be written to: " + std::strerror(errno) + remedy(errno));
}

}  // namespace varve
