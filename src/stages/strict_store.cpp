#include "stages/strict_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace varve {
namespace {

/// Reads or writes all of it; false with errno set when that fails.
template <class Transfer>
bool whole(Transfer transfer, std::byte* data, std::size_t bytes, off_t at) {
  while (bytes > 0) {
    const ssize_t n = transfer(data, bytes, at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      if (n == 0) errno = EIO;
      return false;
    }
    data += n;
    bytes -= std::size_t(n);
    at += n;
  }
  return true;
}

/// Every plane of the sides of a frame, rows without their padding.
template <class Visit>
void each_row(std::vector<StrictSide>& sides, Visit visit) {
  for (StrictSide& side : sides) {
    const auto rows = [&](auto& plane) {
      const Window& w = plane.window();
      for (int y = w.y0; !plane.empty() && y < w.y1; ++y)
        visit(reinterpret_cast<std::byte*>(plane.row(y)), sizeof(*plane.row(y)) * std::size_t(w.width()));
    };
    rows(side.color);
    rows(side.total);
    rows(side.spread);
    rows(side.reject);
    rows(side.clip);
  }
}

/// What is needed to make the planes again.
struct Shape {
  Window window;
  bool reject, clip;
  AccumulateCounts counts;
};

}  // namespace

struct StrictStore::File {
  struct Entry {
    off_t at;
    std::vector<Shape> shapes;
  };
  int descriptor = -1;
  off_t end = 0;
  std::string folder;
  std::map<std::size_t, Entry> entries;

  explicit File(const std::string& where) : folder(where) {
    std::string name = folder + "/.varve-spill-XXXXXX";
    descriptor = ::mkostemp(name.data(), 0);
    if (descriptor < 0) fail("cannot be made");
    ::unlink(name.c_str());
  }
  ~File() {
    if (descriptor >= 0) ::close(descriptor);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[noreturn]] void fail(const char* what) const {
    throw Failure(ExitCode::output, "the spill file in '" + folder + "' " + what + ": " + std::strerror(errno) +
                                        "; make room or name another folder with --spill, or resolve without it");
  }
};

StrictStore::StrictStore(const std::string& folder) {
  if (!folder.empty()) file_ = std::make_unique<File>(folder);
}
StrictStore::~StrictStore() = default;
StrictStore::StrictStore(StrictStore&&) noexcept = default;
StrictStore& StrictStore::operator=(StrictStore&&) noexcept = default;

void StrictStore::put(std::size_t index, std::vector<StrictSide> sides) {
  if (!file_) {
    kept_[index] = std::move(sides);
    return;
  }
  File::Entry entry{file_->end, {}};
  for (const StrictSide& side : sides)
    entry.shapes.push_back({side.color.window(), !side.reject.empty(), !side.clip.empty(), side.counts});
  each_row(sides, [&](std::byte* row, std::size_t bytes) {
    const auto write = [&](std::byte* p, std::size_t n, off_t at) { return ::pwrite(file_->descriptor, p, n, at); };
    if (!whole(write, row, bytes, file_->end)) file_->fail("cannot be written");
    file_->end += off_t(bytes);
  });
  file_->entries[index] = std::move(entry);
}

bool StrictStore::has(std::size_t index) const {
  return file_ ? file_->entries.contains(index) : kept_.contains(index);
}

std::vector<StrictSide> StrictStore::take(std::size_t index) {
  std::vector<StrictSide> sides;
  if (!file_) {
    sides = std::move(kept_.at(index));
    kept_.erase(index);
    return sides;
  }
  const File::Entry entry = std::move(file_->entries.at(index));
  file_->entries.erase(index);
  for (const Shape& shape : entry.shapes) {
    const Window& w = shape.window;
    sides.push_back({Plane<glm::vec4>(w), Plane<float>(w), Plane<float>(w),
                     shape.reject ? Plane<std::uint32_t>(w) : Plane<std::uint32_t>(),
                     shape.clip ? Plane<float>(w) : Plane<float>(), shape.counts});
  }
  off_t at = entry.at;
  each_row(sides, [&](std::byte* row, std::size_t bytes) {
    const auto read = [&](std::byte* p, std::size_t n, off_t from) { return ::pread(file_->descriptor, p, n, from); };
    if (!whole(read, row, bytes, at)) file_->fail("cannot be read");
    at += off_t(bytes);
  });
  return sides;
}

void StrictStore::clear() {
  kept_.clear();
  if (!file_) return;
  file_->entries.clear();
  file_->end = 0;
}

}  // namespace varve
