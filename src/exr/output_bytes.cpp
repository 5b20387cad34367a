#include "exr/output_bytes.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "base/error.h"
#include "exr/write_frame.h"

namespace varve {

void OutputBytes::write_at(std::uint64_t offset, const void* bytes, std::size_t count) {
  const char* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t n = ::pwrite(file_.descriptor(), from, count, off_t(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) refuse_output("write", path_, n < 0 ? errno : ENOSPC);
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
  if (::stat(folder.c_str(), &status) != 0) refuse_output("use the folder", folder, errno);
  if (!S_ISDIR(status.st_mode))
    throw Failure(ExitCode::output, "'" + folder + "' is a file, not a folder; choose another output name");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) refuse_output("write to the folder", folder, errno);
}

}  // namespace varve
