// The byte shuffles of ZIP chunks against their one-byte-at-a-time twins, and packing there and back.
#include "exr/zip_chunk.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace varve {
namespace {

std::vector<std::uint8_t> noise(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(count);
  for (std::uint8_t& b : bytes) b = std::uint8_t(random());
  return bytes;
}

TEST(ZipChunk, DifferencesEqualThePlainOnesForEveryLength) {
  for (std::size_t n = 0; n < 200; ++n) {
    const std::vector<std::uint8_t> bytes = noise(n, unsigned(n));
    std::vector<std::uint8_t> fast(n), plain(n);
    take_differences(bytes.data(), fast.data(), n);
    take_differences_plain(bytes.data(), plain.data(), n);
    EXPECT_EQ(fast, plain) << n;
    undo_differences(fast.data(), n);
    EXPECT_EQ(fast, bytes) << n;
    undo_differences_plain(plain.data(), n);
    EXPECT_EQ(plain, bytes) << n;
  }
}

TEST(ZipChunk, SplitAndJoinAreInverse) {
  for (std::size_t pairs = 0; pairs < 100; ++pairs) {
    const std::vector<std::uint8_t> bytes = noise(2 * pairs, unsigned(pairs));
    std::vector<std::uint8_t> even(pairs), odd(pairs), back(2 * pairs);
    split_bytes(bytes.data(), even.data(), odd.data(), pairs);
    for (std::size_t k = 0; k < pairs; ++k) {
      EXPECT_EQ(even[k], bytes[2 * k]);
      EXPECT_EQ(odd[k], bytes[2 * k + 1]);
    }
    join_bytes(even.data(), odd.data(), back.data(), pairs);
    EXPECT_EQ(back, bytes);
  }
}

TEST(ZipChunk, PackedBytesComeBackAndNothingElse) {
  for (int level = 1; level <= 9; ++level) {
    ZipWriter writer(level);
    ZipReader reader;
    const std::size_t size = 5000;
    std::vector<std::uint8_t> truth(size), packed;
    for (std::size_t i = 0; i < size; ++i) truth[i] = std::uint8_t(i / 50 * 3);
    std::copy(truth.begin(), truth.end(), writer.planes(size));
    ASSERT_TRUE(writer.pack(size, packed));
    ASSERT_LT(packed.size(), size);
    const auto back = reader.unpack(packed, size);
    EXPECT_TRUE(std::vector<std::uint8_t>(back.begin(), back.end()) == truth);
    EXPECT_TRUE(reader.unpack(packed, size - 1).empty());
    EXPECT_TRUE(reader.unpack(packed, size + 1).empty());
    std::vector<std::uint8_t> damaged = packed;
    damaged[packed.size() / 2] ^= 16;
    EXPECT_TRUE(reader.unpack(damaged, size).empty());
    // Noise does not shrink: the chunk is to be stored raw.
    const std::vector<std::uint8_t> random = noise(size, 1);
    std::copy(random.begin(), random.end(), writer.planes(size));
    EXPECT_FALSE(writer.pack(size, packed));
  }
}

}  // namespace
}  // namespace varve
