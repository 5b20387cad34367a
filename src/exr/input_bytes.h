// A file open for positional reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace varve {

/// Bytes of one file. Reads name their offset, so threads may share it. Move-only; closed with the object.
class InputBytes {
 public:
  /// Throws Failure(input) when the file is missing, unreadable or not a regular file.
  explicit InputBytes(const std::string& path);
  /// Takes over a descriptor; `path` is only what messages call it.
  InputBytes(int descriptor, const std::string& path);
  InputBytes(InputBytes&& other) noexcept;
  InputBytes& operator=(InputBytes&& other) noexcept;
  ~InputBytes();

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Reads up to `count` bytes and returns how many there were; fewer only at the end of the file.
  std::size_t read_some(std::uint64_t offset, void* to, std::size_t count) const;
  /// Reads exactly `count` bytes; throws Failure(input) saying that `what` is cut off.
  void read(std::uint64_t offset, void* to, std::size_t count, const char* what) const;

 private:
  void measure();

  std::string path_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
};

}  // namespace varve
