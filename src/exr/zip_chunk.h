// ZIP and ZIPS chunks: byte planes split, differences, deflate. libdeflate does the deflating: it takes half the time
// of zlib, and the files stay ordinary ZIP.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;
struct libdeflate_decompressor;

namespace varve {

/// Undoes the differences in place: bytes[i] += bytes[i-1] - 128.
void undo_differences(std::uint8_t* bytes, std::size_t count);
/// Stores the differences of `from` to `to` (no overlap): to[i] = from[i] - from[i-1] + 128, to[0] = from[0].
void take_differences(const std::uint8_t* from, std::uint8_t* to, std::size_t count);
/// One byte at a time: what the two above must equal.
void undo_differences_plain(std::uint8_t* bytes, std::size_t count);
void take_differences_plain(const std::uint8_t* from, std::uint8_t* to, std::size_t count);

/// to[2k] = even[k], to[2k+1] = odd[k] for k < pairs.
void join_bytes(const std::uint8_t* even, const std::uint8_t* odd, std::uint8_t* to, std::size_t pairs);
/// even[k] = from[2k], odd[k] = from[2k+1] for k < pairs.
void split_bytes(const std::uint8_t* from, std::uint8_t* even, std::uint8_t* odd, std::size_t pairs);

/// Inflates ZIP chunks. One per worker.
class ZipReader {
 public:
  ZipReader();
  /// The chunk's bytes with differences undone: first all even bytes, then all odd ones. Empty when `packed` is
  /// corrupt or does not inflate to exactly `size` bytes. Valid until the next call.
  std::span<const std::uint8_t> unpack(std::span<const std::uint8_t> packed, std::size_t size);

 private:
  struct Free {
    void operator()(libdeflate_decompressor* p) const;
  };
  std::unique_ptr<libdeflate_decompressor, Free> inflate_;
  std::vector<std::uint8_t> bytes_;
};

/// Deflates ZIP chunks. One per worker.
class ZipWriter {
 public:
  explicit ZipWriter(int level);
  /// Room for `size` bytes of a chunk, even bytes first, to be filled by the caller before `pack`.
  std::uint8_t* planes(std::size_t size);
  /// Compresses what `planes` holds into `packed`; false when it would not get smaller (the chunk is then stored raw).
  bool pack(std::size_t size, std::vector<std::uint8_t>& packed);

 private:
  struct Free {
    void operator()(libdeflate_compressor* p) const;
  };
  std::unique_ptr<libdeflate_compressor, Free> deflate_;
  std::vector<std::uint8_t> planes_, differences_;
};

}  // namespace varve
