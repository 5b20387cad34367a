#include "exr/zip_chunk.h"

#include <libdeflate.h>

#include <new>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace varve {

void undo_differences_plain(std::uint8_t* bytes, std::size_t count) {
  for (std::size_t i = 1; i < count; ++i) bytes[i] = std::uint8_t(bytes[i - 1] + bytes[i] - 128);
}

void take_differences_plain(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  if (count > 0) to[0] = from[0];
  for (std::size_t i = 1; i < count; ++i) to[i] = std::uint8_t(from[i] - from[i - 1] + 128);
}

#if defined(__SSE2__)

namespace {

__m128i load16(const std::uint8_t* from) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from)); }
void store16(std::uint8_t* to, __m128i value) { _mm_storeu_si128(reinterpret_cast<__m128i*>(to), value); }

}  // namespace

void undo_differences(std::uint8_t* bytes, std::size_t count) {
  const __m128i bias = _mm_set1_epi8(-128), zero = _mm_setzero_si128();
  // The first byte is stored without the bias; starting from 128 gives it back.
  __m128i carry = bias;
  std::size_t i = 0;
  for (; i + 16 <= count; i += 16) {
    const __m128i step = _mm_xor_si128(load16(bytes + i), bias);  // - 128 modulo 256
    // The total of the 16 bytes comes from sums of absolute differences, apart from the prefix sums, so that the
    // chain from block to block is one addition.
    const __m128i halves = _mm_sad_epu8(step, zero);
    __m128i total = _mm_add_epi8(halves, _mm_shuffle_epi32(halves, _MM_SHUFFLE(1, 0, 3, 2)));
    total = _mm_unpacklo_epi8(total, total);
    total = _mm_shuffle_epi32(_mm_shufflelo_epi16(total, 0), 0);
    __m128i sum = _mm_add_epi8(step, _mm_slli_si128(step, 1));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
    sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
    store16(bytes + i, _mm_add_epi8(sum, carry));
    carry = _mm_add_epi8(carry, total);
  }
  // The rest goes on from the byte before it.
  if (i > 0)
    undo_differences_plain(bytes + i - 1, count - i + 1);
  else
    undo_differences_plain(bytes, count);
}

void take_differences(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  const __m128i bias = _mm_set1_epi8(-128);
  if (count > 0) to[0] = from[0];
  std::size_t i = 1;
  for (; i + 16 <= count; i += 16)
    store16(to + i, _mm_xor_si128(_mm_sub_epi8(load16(from + i), load16(from + i - 1)), bias));
  for (; i < count; ++i) to[i] = std::uint8_t(from[i] - from[i - 1] + 128);
}

void join_bytes(const std::uint8_t* even, const std::uint8_t* odd, std::uint8_t* to, std::size_t pairs) {
  std::size_t k = 0;
  for (; k + 16 <= pairs; k += 16) {
    const __m128i a = load16(even + k), b = load16(odd + k);
    store16(to + 2 * k, _mm_unpacklo_epi8(a, b));
    store16(to + 2 * k + 16, _mm_unpackhi_epi8(a, b));
  }
  for (; k < pairs; ++k) {
    to[2 * k] = even[k];
    to[2 * k + 1] = odd[k];
  }
}

void split_bytes(const std::uint8_t* from, std::uint8_t* even, std::uint8_t* odd, std::size_t pairs) {
  const __m128i low = _mm_set1_epi16(255);
  std::size_t k = 0;
  for (; k + 16 <= pairs; k += 16) {
    const __m128i a = load16(from + 2 * k), b = load16(from + 2 * k + 16);
    store16(even + k, _mm_packus_epi16(_mm_and_si128(a, low), _mm_and_si128(b, low)));
    store16(odd + k, _mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8)));
  }
  for (; k < pairs; ++k) {
    even[k] = from[2 * k];
    odd[k] = from[2 * k + 1];
  }
}

#else

void undo_differences(std::uint8_t* bytes, std::size_t count) { undo_differences_plain(bytes, count); }

void take_differences(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  take_differences_plain(from, to, count);
}

void join_bytes(const std::uint8_t* even, const std::uint8_t* odd, std::uint8_t* to, std::size_t pairs) {
  for (std::size_t k = 0; k < pairs; ++k) {
    to[2 * k] = even[k];
    to[2 * k + 1] = odd[k];
  }
}

void split_bytes(const std::uint8_t* from, std::uint8_t* even, std::uint8_t* odd, std::size_t pairs) {
  for (std::size_t k = 0; k < pairs; ++k) {
    even[k] = from[2 * k];
    odd[k] = from[2 * k + 1];
  }
}

#endif

void ZipReader::Free::operator()(libdeflate_decompressor* p) const { libdeflate_free_decompressor(p); }
void ZipWriter::Free::operator()(libdeflate_compressor* p) const { libdeflate_free_compressor(p); }

ZipReader::ZipReader() : inflate_(libdeflate_alloc_decompressor()) {
  if (!inflate_) throw std::bad_alloc();
}

std::span<const std::uint8_t> ZipReader::unpack(std::span<const std::uint8_t> packed, std::size_t size) {
  if (bytes_.size() < size) bytes_.resize(size);
  // Without a place for the actual size libdeflate demands exactly `size` bytes.
  const libdeflate_result result =
      libdeflate_zlib_decompress(inflate_.get(), packed.data(), packed.size(), bytes_.data(), size, nullptr);
  if (result != LIBDEFLATE_SUCCESS) return {};
  undo_differences(bytes_.data(), size);
  return {bytes_.data(), size};
}

ZipWriter::ZipWriter(int level) : deflate_(libdeflate_alloc_compressor(level)) {
  if (!deflate_) throw std::bad_alloc();
}

std::uint8_t* ZipWriter::planes(std::size_t size) {
  if (planes_.size() < size) planes_.resize(size);
  return planes_.data();
}

bool ZipWriter::pack(std::size_t size, std::vector<std::uint8_t>& packed) {
  if (differences_.size() < size) differences_.resize(size);
  take_differences(planes_.data(), differences_.data(), size);
  packed.resize(size);
  // A reader takes a chunk of full size for one stored raw, so the compressed one must be smaller.
  const std::size_t used = libdeflate_zlib_compress(deflate_.get(), differences_.data(), size, packed.data(), size - 1);
  packed.resize(used);
  return used > 0;
}

}  // namespace varve
