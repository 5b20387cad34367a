// Damaged files from the command line: a sentence that names the file, exit code 3, bounded memory and time, nothing
// under the final name that is not whole, and the frames before stay as they were.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "fuzz/targets.h"
#include "program.h"
#include "sentence.h"
#include "support/exr_shape.h"

namespace varve::test {
namespace {

using fuzz::NamedSeed;

constexpr RunLimits kLimits{512, 20};

void spill(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes.data(), std::streamsize(bytes.size()));
}

const std::vector<NamedSeed>& files() {
  static const std::vector<NamedSeed> all = fuzz::named_seeds();
  return all;
}

const std::string& file_named(const std::string& name) {
  for (const NamedSeed& seed : files())
    if (seed.name == name) return seed.bytes;
  throw std::runtime_error(name);
}

template <class T>
std::string with_number(std::string bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

/// Where an attribute's value lies in a file.
std::size_t value_at(const std::string& bytes, const std::string& attribute) {
  for (const ExrField& field : exr_shape(bytes).fields)
    if (field.kind == ExrFieldKind::attribute_value && field.attribute == attribute) return field.at;
  throw std::runtime_error(attribute);
}

class FilesCli : public testing::Test {
 protected:
  /// Three frames, the second of which is damaged.
  Outcome resolve(const std::string& good, const std::string& bad) const {
    for (const char* name : {"in.0001.exr", "in.0003.exr"}) spill(folder / name, good);
    spill(folder / "in.0002.exr", bad);
    for (const char* name : {"out.0001.exr", "out.0002.exr", "out.0003.exr"}) std::filesystem::remove(folder / name);
    return run_varve({"resolve", "in.####.exr", "-o", "out.####.exr", "--convention", "none", "-q", "-j", "2"},
                     folder.path(), kLimits);
  }

  /// Refused for frame 2: what was written before is whole, and nothing else is there.
  void expect_refused_frame(const std::string& good, const std::string& bad, const std::string& whole) const {
    const Outcome outcome = resolve(good, bad);
    expect_refused(outcome, 3, "in.0002.exr");
    std::vector<std::string> names = files_below(folder.path());
    std::erase_if(names, [](const std::string& name) { return name.starts_with("in."); });
    if (!names.empty()) {
      EXPECT_EQ(names, std::vector<std::string>{"out.0001.exr"});
      EXPECT_EQ(bytes_of(folder / "out.0001.exr"), whole);
    }
  }

  /// The same by a probe, which reads headers only.
  void expect_refused_probe() const {
    expect_refused(run_varve({"probe", "in.0002.exr", "--convention", "none"}, folder.path(), kLimits), 3,
                   "in.0002.exr");
  }

  /// What the first frame becomes when nothing is wrong.
  std::string first_of(const std::string& good) const {
    const Outcome outcome = resolve(good, good);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return bytes_of(folder / "out.0001.exr");
  }

  Folder folder;
};

class TruncatedFiles : public FilesCli, public testing::WithParamInterface<const char*> {};

TEST_P(TruncatedFiles, AreRefusedAtEveryChunkAndTheFramesBeforeStay) {
  const std::string& good = file_named(GetParam());
  const std::string whole = first_of(good);
  const ExrShape shape = exr_shape(good);
  ASSERT_FALSE(shape.chunks.empty());
  std::vector<std::size_t> boundaries = {8, shape.table_at, shape.data_at};
  // Of many tiles or lines the second and the last one; the first is the end of the tables.
  for (std::size_t i : {std::size_t(1), shape.chunks.size() - 1})
    if (i < shape.chunks.size()) boundaries.push_back(shape.chunks[i]);
  std::ranges::sort(boundaries);
  boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
  for (const std::size_t boundary : boundaries)
    for (const int step : {-1, 0, 1}) {
      SCOPED_TRACE(std::string(GetParam()) + " cut at " + std::to_string(boundary) + " " + std::to_string(step));
      expect_refused_frame(good, good.substr(0, boundary + std::size_t(step)), whole);
      if (boundary + std::size_t(step) < shape.table_at) expect_refused_probe();
    }
  expect_refused_frame(good, good.substr(0, good.size() - 1), whole);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TruncatedFiles,
                         testing::Values("none", "zip", "piz", "dwaa", "b44", "pxr24", "tiled", "parts", "deep",
                                         "deep tiled"),
                         [](const auto& kind) {
                           std::string name = kind.param;
                           std::erase(name, ' ');
                           return name;
                         });

TEST_F(FilesCli, FlippedHeaderBytesEndInPixelsOrInASentence) {
  // Every byte of the headers is done by varve_fuzz in one process; here some, through the program.
  for (const char* kind : {"zip", "parts", "deep tiled"}) {
    const std::string& good = file_named(kind);
    const std::size_t reach = exr_shape(good).data_at;
    for (std::size_t at = 0; at < reach; at += 37) {
      std::string bad = good;
      bad[at] = char(bad[at] ^ 0x41);
      SCOPED_TRACE(std::string(kind) + " byte " + std::to_string(at));
      const Outcome outcome = resolve(good, bad);
      if (outcome.code == 0) continue;
      expect_refused(outcome, outcome.code == 4 ? 4 : 3, outcome.code == 4 ? "" : "in.0002.exr");
    }
  }
}

TEST_F(FilesCli, FlippedPixelBytesEndInPixelsOrInASentence) {
  for (const NamedSeed& seed : files()) {
    const std::string whole = first_of(seed.bytes);
    const std::size_t begin = exr_shape(seed.bytes).data_at, reach = seed.bytes.size() - begin;
    for (std::size_t i = 0; i < 4; ++i) {
      std::string bad = seed.bytes;
      bad[begin + (reach * i) / 4 + 9 % reach] ^= char(1 << (2 * i));
      SCOPED_TRACE(seed.name + " flip " + std::to_string(i));
      const Outcome outcome = resolve(seed.bytes, bad);
      EXPECT_TRUE(outcome.code == 0 || outcome.code == 3) << outcome.code << outcome.err;
      if (outcome.code != 0) expect_refused(outcome, 3, "in.0002.exr");
      EXPECT_EQ(bytes_of(folder / "out.0001.exr"), whole);
    }
  }
}

TEST_F(FilesCli, HugeWindowsAndTilesAreRefused) {
  constexpr std::int32_t kBig = 2147483647;
  for (const char* kind : {"zip", "dwaa", "tiled", "parts", "deep tiled"}) {
    const std::string& good = file_named(kind);
    const std::string whole = first_of(good);
    for (const char* window : {"dataWindow", "displayWindow"})
      for (const std::int32_t edge : {kBig, 1 << 21, 999999}) {
        SCOPED_TRACE(std::string(kind) + " " + window + " " + std::to_string(edge));
        // To the right and downwards; a display window is allowed to be large, but not as large as that.
        const std::size_t at = value_at(good, window);
        if (std::string(window) == "displayWindow" && edge < 1 << 20) continue;
        expect_refused_frame(good, with_number(with_number(good, at + 8, edge), at + 12, edge), whole);
      }
    if (std::string(kind).find("tiled") == std::string::npos) continue;
    for (const std::uint32_t edge : {0u, 1u, 65536u, 0x80000000u})
      expect_refused_frame(good, with_number(good, value_at(good, "tiles"), edge), whole);
  }
}

TEST_F(FilesCli, PartNamesMustBeTheirOwn) {
  const std::string& good = file_named("parts");
  const std::string whole = first_of(good);
  std::string twice = good;
  twice.replace(twice.find("fg"), 2, "bg");
  expect_refused_frame(good, twice, whole);
  // Without any name, which the attribute that is renamed away leaves behind.
  std::string none = good;
  const std::size_t name = none.find(std::string("name\0string\0", 12));
  ASSERT_NE(name, std::string::npos);
  none.replace(name, 4, "nama");
  expect_refused_frame(good, none, whole);
}

TEST_F(FilesCli, ChunkTablesThatLieAreRefused) {
  for (const char* kind : {"zip", "piz", "parts", "deep tiled"}) {
    const std::string& good = file_named(kind);
    const std::string whole = first_of(good);
    const std::vector<std::size_t> chunks = exr_shape(good).chunks;
    const ExrShape shape = exr_shape(good);
    const std::size_t first = shape.of(ExrFieldKind::table_entry).at(0)->at;
    const std::uint64_t huge = ~std::uint64_t(0) >> 1;
    for (const std::uint64_t offset : {std::uint64_t(0), std::uint64_t(8), std::uint64_t(shape.table_at),
                                       std::uint64_t(good.size()), huge, ~std::uint64_t(0)}) {
      SCOPED_TRACE(std::string(kind) + " offset " + std::to_string(offset));
      expect_refused_frame(good, with_number(good, first, offset), whole);
    }
    // Two entries that name one chunk, and two that were swapped.
    if (chunks.size() < 2) continue;
    expect_refused_frame(good, with_number(good, first, std::uint64_t(chunks[1])), whole);
  }
}

TEST_F(FilesCli, DeepCountsThatLieAreRefused) {
  for (const char* kind : {"deep", "deep tiled"}) {
    const std::string& good = file_named(kind);
    const std::string whole = first_of(good);
    const ExrShape shape = exr_shape(good);
    const auto sizes = shape.of(ExrFieldKind::chunk_size);
    ASSERT_GE(sizes.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::uint64_t claim : {std::uint64_t(1), std::uint64_t(1) << 33, ~std::uint64_t(0)}) {
        SCOPED_TRACE(std::string(kind) + " size " + std::to_string(i) + " " + std::to_string(claim));
        expect_refused_frame(good, with_number(good, sizes[i]->at, claim), whole);
      }
  }
  // Counts as they are stored plainly: each includes those of the pixels before.
  const std::string& good = file_named("deep");
  const std::string whole = first_of(good);
  const ExrShape plain = exr_shape(good);
  const std::size_t counts = plain.of(ExrFieldKind::chunk_bytes).at(0)->at;
  for (const std::int32_t count : {-1, 2147483647, 5})
    for (const std::size_t pixel : {0u, 10u}) {
      SCOPED_TRACE(std::to_string(count) + " at " + std::to_string(pixel));
      std::int32_t now = 0;
      std::memcpy(&now, good.data() + counts + 4 * pixel, 4);
      if (now != count) expect_refused_frame(good, with_number(good, counts + 4 * pixel, count), whole);
    }
}

TEST_F(FilesCli, NamesWithControlCharactersCannotForgeLines) {
  std::string bad = file_named("parts");
  for (std::size_t at = bad.find("fg"); at != std::string::npos; at = bad.find("bg")) bad.replace(at, 2, "\n\x1b");
  spill(folder / "in.0001.exr", bad);
  const Outcome outcome = run_varve({"resolve", "in.####.exr", "-o", "out.####.exr"}, folder.path(), kLimits);
  expect_refused(outcome, 3, "two parts named '\\n\\x1b'");
}

}  // namespace
}  // namespace varve::test
