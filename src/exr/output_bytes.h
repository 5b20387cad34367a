// A file that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace varve {

/// Bytes written beside `path` under a hidden name that holds the process id; `commit` gives them their name. Without
/// it they are removed. Every call throws Failure(output) with path, reason and remedy.
class OutputBytes {
 public:
  explicit OutputBytes(const std::string& path);
  OutputBytes(const OutputBytes&) = delete;
  OutputBytes& operator=(const OutputBytes&) = delete;
  ~OutputBytes();

  std::uint64_t size() const { return size_; }
  void append(const void* bytes, std::size_t count);
  void overwrite(std::uint64_t offset, const void* bytes, std::size_t count);
  /// Flushes to the disk, renames, flushes the folder.
  void commit();

 private:
  void write_at(std::uint64_t offset, const void* bytes, std::size_t count);
  [[noreturn]] void fail(const char* action, int reason) const;

  std::string path_, folder_, temporary_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
};

}  // namespace varve
