// A file that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "exr/temporary_file.h"

namespace varve {

/// Bytes written into a TemporaryFile beside `path`; `commit` gives them their name. Without it they are removed. Every
/// call throws Failure(output) with path, reason and remedy.
class OutputBytes {
 public:
  explicit OutputBytes(const std::string& path) : path_(path), file_(path) {}

  std::uint64_t size() const { return size_; }
  void append(const void* bytes, std::size_t count);
  void overwrite(std::uint64_t offset, const void* bytes, std::size_t count);
  /// Flushes to the disk, renames, flushes the folder.
  void commit() { file_.commit(); }

 private:
  void write_at(std::uint64_t offset, const void* bytes, std::size_t count);

  std::string path_;
  TemporaryFile file_;
  std::uint64_t size_ = 0;
};

}  // namespace varve
