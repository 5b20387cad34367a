#include "exr/temporary_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string_view>

#include "base/error.h"

namespace varve {
namespace {

constexpr std::string_view kMark = ".varve-", kEnd = ".tmp";
constexpr std::size_t kLongestStem = 200;          // of the 255 bytes that a name may have
constexpr std::time_t kForeignAge = 24 * 60 * 60;  // s; a lock of another machine may not be seen from here

const char* remedy(int reason) {
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space or choose another folder";
    case EFBIG:
      return "; the limit on the size of files (ulimit -f) is too low for it";
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

/// FNV-1a of the machine's name: names of machines are nobody's business, and may hold anything.
std::string host_mark() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  std::uint32_t h = 2166136261u;
  for (const char* c = name.data(); *c; ++c) h = (h ^ static_cast<unsigned char>(*c)) * 16777619u;
  std::array<char, 9> hex{};
  std::snprintf(hex.data(), hex.size(), "%08x", h);
  return hex.data();
}

bool lock(int descriptor, int how) {
  int result;
  do result = ::flock(descriptor, how);
  while (result != 0 && errno == EINTR);
  return result == 0;
}

/// Who made a temporary file, by its name.
struct Maker {
  std::string_view host;
  pid_t process = 0;
};

std::optional<Maker> maker_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kEnd)) return std::nullopt;
  name.remove_suffix(kEnd.size());
  const std::size_t mark = name.rfind(kMark);
  if (mark == std::string_view::npos) return std::nullopt;
  name.remove_prefix(mark + kMark.size());
  const std::size_t first = name.find('-'), second = name.find('-', first + 1);
  if (first != 8 || second == std::string_view::npos) return std::nullopt;
  Maker maker{name.substr(0, first), 0};
  const char *begin = name.data() + first + 1, *end = name.data() + second;
  if (std::from_chars(begin, end, maker.process).ptr != end || maker.process <= 0) return std::nullopt;
  return maker;
}

/// Whether nobody writes it; the caller holds its lock, if locks work.
bool is_abandoned(int descriptor, const Maker& maker, const std::string& host) {
  const bool ours = maker.host == host;
  if (!lock(descriptor, LOCK_EX | LOCK_NB))
    return errno != EWOULDBLOCK && ours && ::kill(maker.process, 0) != 0 && errno == ESRCH;
  struct stat status {};
  return ours || (::fstat(descriptor, &status) == 0 && std::time(nullptr) - status.st_mtime > kForeignAge);
}

bool remove_abandoned(const std::string& path, const Maker& maker, const std::string& host) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return false;
  struct stat opened {
  }, named{};
  const bool removed = ::fstat(descriptor, &opened) == 0 && S_ISREG(opened.st_mode) &&
                       is_abandoned(descriptor, maker, host) && ::stat(path.c_str(), &named) == 0 &&
                       named.st_ino == opened.st_ino && named.st_dev == opened.st_dev && ::unlink(path.c_str()) == 0;
  ::close(descriptor);
  return removed;
}

}  // namespace

std::string folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

void refuse_output(const char* action, const std::string& path, int reason) {
  throw Failure(ExitCode::output,
                std::string("cannot ") + action + " '" + path + "': " + std::strerror(reason) + remedy(reason));
}

TemporaryFile::TemporaryFile(const std::string& path) : path_(path), folder_(folder_of(path)) { create(); }

TemporaryFile::~TemporaryFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  forget();
}

void TemporaryFile::forget() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void TemporaryFile::create() {
  const std::string stem = folder_ + "/." + std::filesystem::path(path_).filename().string().substr(0, kLongestStem) +
                           std::string(kMark) + host_mark() + "-" + std::to_string(::getpid());
  // The number tells writers of one process apart; it is also what a crashed process of the same id may have left.
  for (int n = 0;; ++n) {
    temporary_ = stem + "-" + std::to_string(n) + std::string(kEnd);
    descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      const int reason = errno;
      temporary_.clear();
      if (reason != EINTR && (reason != EEXIST || n >= 1000)) refuse_output("create", path_, reason);
      continue;
    }
    // Between the two calls it may have been taken for a leftover: then it has no name any more.
    struct stat status {};
    lock(descriptor_, LOCK_EX);
    if (::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) return;
    forget();
  }
}

void TemporaryFile::commit() {
  if (::fsync(descriptor_) != 0) refuse_output("write", path_, errno);
  // Renamed before it is closed: closing ends the lock.
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) refuse_output("create", path_, errno);
  temporary_.clear();
  forget();
  // The name itself is safe only once the folder is on disk. Some file systems cannot flush folders; that is no reason
  // to call a complete file a failure.
  const int folder = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

std::size_t remove_leftovers(const std::string& folder) {
  const std::string host = host_mark();
  std::size_t removed = 0;
  std::error_code problem;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, problem);
  for (const std::filesystem::directory_iterator end; !problem && entry != end; entry.increment(problem)) {
    const std::string name = entry->path().filename().string();
    if (const std::optional<Maker> maker = maker_of(name))
      removed += remove_abandoned(entry->path().string(), *maker, host);
  }
  return removed;
}

}  // namespace varve
