// Deep parts read line by line: what the stock library wrote, nothing else, and refused where it is damaged.
#include "exr/read_deep.h"

#include <OpenEXR/ImfCompositeDeepScanLine.h>
#include <OpenEXR/ImfDeepScanLineInputFile.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <random>

#include "exr/convert.h"
#include "exr_test_files.h"
#include "paths.h"
#include "stages/flatten_deep.h"
#include "support/deep_file.h"

namespace varve::test {
namespace {

/// Odd windows, empty pixels, all types; values that halves hold exactly.
DeepTestPart small_part(int tile, Imf::Compression compression, unsigned seed = 1) {
  DeepTestPart part = deep_part(
      13, 7, {{"A", Imf::HALF}, {"R", Imf::HALF}, {"Z", Imf::FLOAT}, {"ZBack", Imf::FLOAT}, {"id", Imf::UINT}});
  part.data = Imath::Box2i({-3, 2}, {9, 8});
  part.display = Imath::Box2i({0, 0}, {15, 11});
  part.tile = tile;
  part.compression = compression;
  part.name = "p" + std::to_string(seed);
  std::mt19937 random(seed);
  for (std::size_t pixel = 0; pixel < part.pixels(); ++pixel)
    for (unsigned n = random() % 5; n-- > 0;) {
      const double z = 1 + random() % 9;
      add_sample(part, pixel,
                 {double(random() % 9) / 8, double(random() % 64) / 8, z, z + random() % 3, double(random())});
    }
  return part;
}

/// All samples of a file as text, pixel by pixel, channel by channel.
std::vector<std::string> samples_of(const std::string& path, int part, const DeepLimits& limits, Workers& workers) {
  const FileHeader header = read_header(path);
  const Part& described = header.parts[std::size_t(part)];
  std::vector<std::string> pixels(described.data_window.pixels());
  std::vector<std::atomic<int>> met(pixels.size());
  read_deep(header, part, limits, workers, [&](const DeepLine& line, int) {
    for (std::size_t x = 0; x < line.pixels(); ++x) {
      const std::size_t pixel =
          std::size_t(line.y - described.data_window.y0) * std::size_t(described.data_window.width()) +
          std::size_t(line.x0 - described.data_window.x0) + x;
      ++met[pixel];
      for (std::size_t c = 0; c < described.channels.size(); ++c)
        for (std::uint32_t s = line.first[x]; s < line.first[x + 1]; ++s) {
          const std::size_t size = bytes_per_pixel(described.channels[c].type);
          pixels[pixel].append(reinterpret_cast<const char*>(line.samples[c] + s * size), size);
        }
    }
  });
  for (const std::atomic<int>& count : met) EXPECT_EQ(count, 1);
  return pixels;
}

std::vector<std::string> samples_of(const DeepTestPart& part) {
  std::vector<std::string> pixels(part.pixels());
  for (const DeepTestChannel& channel : part.channels) {
    const PackedChannel packed = pack(channel);
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel)
      pixels[pixel].append(packed.pointers[pixel], channel.values[pixel].size() * (channel.type == Imf::HALF ? 2 : 4));
  }
  return pixels;
}

constexpr Imf::Compression kCompressions[] = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION};

TEST(ReadDeep, GivesWhatTheLibraryWrote) {
  Folder folder;
  Workers workers(3);
  for (const Imf::Compression compression : kCompressions)
    for (const int tile : {0, 4, 64}) {
      const std::vector<DeepTestPart> parts = {small_part(tile, compression, 1), small_part(0, compression, 2)};
      write_deep(folder / "one.exr", {parts[0]});
      write_deep(folder / "two.exr", parts);
      for (const std::uint64_t band : {std::uint64_t(1), std::uint64_t(600), std::uint64_t(1) << 30}) {
        DeepLimits limits;
        limits.band_bytes = band;
        EXPECT_TRUE(samples_of(folder / "one.exr", 0, limits, workers) == samples_of(parts[0])) << compression << tile;
        EXPECT_TRUE(samples_of(folder / "two.exr", 0, limits, workers) == samples_of(parts[0])) << compression << tile;
        EXPECT_TRUE(samples_of(folder / "two.exr", 1, limits, workers) == samples_of(parts[1])) << compression << tile;
      }
    }
}

FrameHeaders frame_of(const FileHeader& header) {
  FrameHeaders headers;
  headers.files.push_back(header);
  return headers;
}

/// True when nothing was refused.
bool use(const std::string& path, Workers& workers) {
  try {
    const FileHeader header = read_header(path);
    std::vector<ChannelRef> channels;
    for (std::size_t p = 0; p < header.parts.size(); ++p)
      for (std::size_t c = 0; c < header.parts[p].channels.size(); ++c) channels.push_back({0, int(p), int(c)});
    DeepFrame deep;
    read_flat(frame_of(header), 0, channels, {}, {}, deep, workers);
    return true;
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::input) << failure.what();
    EXPECT_EQ(std::string(failure.what()).find("rror"), std::string::npos) << failure.what();
    return false;
  }
}

std::vector<std::string> small_files(const Folder& folder) {
  std::vector<std::string> paths;
  for (const Imf::Compression compression : kCompressions)
    for (const int tile : {0, 4}) {
      paths.push_back(folder / ("in" + std::to_string(compression) + std::to_string(tile) + ".exr"));
      std::vector<DeepTestPart> parts = {small_part(tile, compression, 1)};
      if (compression == Imf::RLE_COMPRESSION) parts.push_back(small_part(0, compression, 2));
      write_deep(paths.back(), parts);
    }
  return paths;
}

TEST(HostileDeep, TruncationAnywhereIsRefused) {
  Folder folder;
  Workers workers(2);
  for (const std::string& path : small_files(folder)) {
    ASSERT_TRUE(use(path, workers)) << path;
    const std::string bytes = slurp(path);
    for (int i = 0; i < 80; ++i) {
      spill(folder / "cut.exr", bytes.substr(0, bytes.size() * std::size_t(i) / 80));
      EXPECT_FALSE(use(folder / "cut.exr", workers)) << path << " cut to " << i << "/80";
    }
  }
}

TEST(HostileDeep, FlippedBytesNeverCrashOrExhaustMemory) {
  Folder folder;
  Workers workers(1);
  std::mt19937 random(3);
  for (const std::string& path : small_files(folder)) {
    const std::string bytes = slurp(path);
    for (int i = 0; i < 150; ++i) {
      std::string bad = bytes;
      for (unsigned n = 1 + random() % 3; n-- > 0;) bad[random() % bad.size()] = char(random());
      spill(folder / "bad.exr", bad);
      use(folder / "bad.exr", workers);
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 1L << 20) << "KiB";
}

/// Where the first chunk of a single-part scanline file begins, by its table.
std::size_t first_chunk(const std::string& bytes, int lines) {
  // The table is followed by the first chunk, and its entries point behind it.
  for (std::size_t at = 0; at + 8 <= bytes.size(); ++at) {
    std::uint64_t offset;
    std::memcpy(&offset, bytes.data() + at, 8);
    if (offset == at + 8 * std::size_t(lines)) return std::size_t(offset);
  }
  return 0;
}

TEST(HostileDeep, LyingCountsAreRefusedBeforeAnythingIsAllocated) {
  Folder folder;
  Workers workers(1);
  write_deep(folder / "in.exr", {small_part(0, Imf::NO_COMPRESSION)});
  const std::string bytes = slurp(folder / "in.exr");
  const std::size_t chunk = first_chunk(bytes, 7);
  ASSERT_GT(chunk, 0u);
  const auto refused = [&](std::size_t at, auto value) {
    std::string bad = bytes;
    std::memcpy(bad.data() + chunk + at, &value, sizeof value);
    spill(folder / "bad.exr", bad);
    const FileHeader header = read_header(folder / "bad.exr");
    const Failure failure = failure_of([&] { read_deep(header, 0, {}, workers, [](const DeepLine&, int) {}); });
    EXPECT_EQ(failure.code(), ExitCode::input);
    return std::string(failure.what());
  };
  EXPECT_NE(refused(0, std::int32_t(5)).find("mixed up"), std::string::npos);
  EXPECT_NE(refused(4, std::uint64_t(1) << 62).find("cut off"), std::string::npos);
  EXPECT_NE(refused(12, std::uint64_t(1) << 40).find("cut off"), std::string::npos);
  EXPECT_NE(refused(20, std::uint64_t(1) << 50).find("claims more"), std::string::npos);
  EXPECT_NE(refused(28 + 4 * 12, std::int32_t(1000)).find("do not agree"), std::string::npos);
  EXPECT_NE(refused(28 + 4 * 12, std::int32_t(0x7fffffff)).find("beyond the limit"), std::string::npos);
  EXPECT_NE(refused(28 + 4 * 3, std::int32_t(-1)).find("counts are corrupt"), std::string::npos);

  DeepLimits tight;
  tight.chunk_bytes = 16;
  const FileHeader header = read_header(folder / "in.exr");
  EXPECT_EQ(failure_of([&] { read_deep(header, 0, tight, workers, [](const DeepLine&, int) {}); }).code(),
            ExitCode::input);
}

TEST(FlattenDeep, SameBytesForAnyThreadsAndBands) {
  Folder folder;
  write_deep(folder / "in.exr", {small_part(4, Imf::ZIPS_COMPRESSION)});
  const FileHeader header = read_header(folder / "in.exr");
  std::vector<ChannelRef> channels;
  for (int c = 0; c < 5; ++c) channels.push_back({0, 0, c});
  std::vector<std::string> first;
  for (const int threads : {1, 4})
    for (const std::uint64_t band : {std::uint64_t(1), std::uint64_t(1) << 26}) {
      Workers workers(threads);
      FlattenOptions options;
      options.limits.band_bytes = band;
      DeepFrame deep;
      const FramePixels frame =
          read_flat(frame_of(header), 0, channels, std::vector{channels[1]}, options, deep, workers);
      EXPECT_EQ(frame.planes[0][1].type, PixelType::float32);  // R is wanted precisely, A as it is stored
      EXPECT_EQ(frame.planes[0][0].type, PixelType::float16);
      EXPECT_TRUE(frame.planes[0][3].empty());  // ZBack
      std::vector<std::string> bytes;
      for (const int c : {0, 1, 2, 4}) bytes.push_back(packed(frame.planes[0][std::size_t(c)]));
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first);
      EXPECT_EQ(deep.counts.pixels, 91u);
    }
}

TEST(FlattenDeep, WinnersLendWhatCannotBeAveraged) {
  Folder folder;
  Workers workers(1);
  DeepTestPart part = deep_part(
      3, 1, {{"A", Imf::HALF}, {"G", Imf::HALF}, {"Z", Imf::HALF}, {"id", Imf::UINT}, {"velocity.x", Imf::FLOAT}});
  add_sample(part, 0, {0.25, 0.25, 2, 7, 1.5});
  add_sample(part, 0, {1, 0.5, 9, 4000000001.0, -3});
  add_sample(part, 2, {0.5, 0.5, 3, 5, 0.1f});
  add_sample(part, 2, {1, 0.5, std::nan(""), 6, 4});
  write_deep(folder / "in.exr", {part});
  const FileHeader header = read_header(folder / "in.exr");
  std::vector<ChannelRef> channels;
  for (int c = 0; c < 5; ++c) channels.push_back({0, 0, c});
  DeepFrame deep;
  const FramePixels frame = read_flat(frame_of(header), 0, channels, {}, {}, deep, workers);
  const auto values = [&](std::size_t c) {
    std::vector<float> row(3);
    to_float(frame.planes[0][c].type, frame.planes[0][c].row(0), row.data(), 3);
    return row;
  };
  EXPECT_EQ(values(0), (std::vector<float>{1, 0, 0.5f}));
  EXPECT_EQ(values(1), (std::vector<float>{0.25f + 0.75f * 0.5f, 0, 0.5f}));
  EXPECT_EQ(values(2), (std::vector<float>{9, 65504, 3}));
  std::uint32_t ids[3];
  std::memcpy(ids, frame.planes[0][3].row(0), sizeof ids);
  EXPECT_EQ(ids[0], 4000000001u);
  EXPECT_EQ(ids[1], 0u);
  EXPECT_EQ(values(4), (std::vector<float>{-3, 0, 0.1f}));
  EXPECT_EQ(deep.counts.samples, 4u);
  EXPECT_EQ(deep.counts.most, 2u);
  EXPECT_EQ(deep.counts.defects.dropped, 1u);
}

struct Picture {
  int width = 0;
  std::vector<float> rgba[4];
};

/// What OpenEXR's own compositing of one or several deep files gives over their common data window.
Picture flatten_by_library(const std::vector<std::string>& paths, const Imath::Box2i& window) {
  std::vector<std::unique_ptr<Imf::DeepScanLineInputFile>> files;
  Imf::CompositeDeepScanLine composite;
  for (const std::string& path : paths) {
    files.push_back(std::make_unique<Imf::DeepScanLineInputFile>(path.c_str()));
    composite.addSource(files.back().get());
  }
  Picture picture;
  picture.width = window.max.x - window.min.x + 1;
  Imf::FrameBuffer frame;
  for (int k = 0; k < 4; ++k) {
    picture.rgba[k].resize(std::size_t(picture.width) * std::size_t(window.max.y - window.min.y + 1));
    char* base =
        reinterpret_cast<char*>(picture.rgba[k].data() - window.min.x - std::ptrdiff_t(window.min.y) * picture.width);
    frame.insert(std::string(1, "RGBA"[k]), Imf::Slice(Imf::FLOAT, base, 4, 4 * std::size_t(picture.width)));
  }
  composite.setFrameBuffer(frame);
  composite.readPixels(window.min.y, window.max.y);
  return picture;
}

TEST(RealDeep, FlattensLikeTheLibrary) {
  Workers workers;
  for (const char* name : {"Balls", "Leaves", "Trunks"}) {
    const std::string path = std::string(VARVE_DATA) + "/deep/" + name + ".exr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    const FileHeader header = read_header(path);
    const Part& part = header.parts[0];
    std::vector<ChannelRef> channels;
    for (const char* channel : {"R", "G", "B", "A"}) channels.push_back({0, 0, *part.channel(channel)});
    DeepFrame deep;
    const FramePixels frame = read_flat(frame_of(header), 0, channels, channels, {}, deep, workers);
    const Window& w = part.data_window;
    const Picture theirs = flatten_by_library({path}, {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}});
    double worst = 0;
    for (std::size_t k = 0; k < 4; ++k)
      for (int y = 0; y < w.height(); ++y) {
        std::vector<float> row(std::size_t(w.width()));
        to_float(PixelType::float32, frame[channels[k]].row(y), row.data(), row.size());
        for (std::size_t x = 0; x < row.size(); ++x)
          worst = std::max(worst, std::abs(double(row[x]) - double(theirs.rgba[k][std::size_t(y * w.width()) + x])));
      }
    EXPECT_LT(worst, 1e-6) << name;
    RecordProperty(name, std::to_string(worst));
  }
}

/// Adds the samples of a file to the pixels of `window`.
void gather_samples(const std::string& path, const Window& window, std::vector<std::vector<DeepSample>>& pixels,
                    Workers& workers) {
  const FileHeader header = read_header(path);
  const Part& part = header.parts[0];
  std::vector<std::size_t> places;
  for (const char* name : {"R", "G", "B", "A", "Z"}) places.push_back(std::size_t(*part.channel(name)));
  read_deep(header, 0, {}, workers, [&](const DeepLine& line, int) {
    std::vector<std::vector<float>> values;
    for (const std::size_t c : places) {
      values.emplace_back(line.count());
      to_float(part.channels[c].type, line.samples[c], values.back().data(), line.count());
    }
    for (std::size_t x = 0; x < line.pixels(); ++x)
      for (std::size_t s = line.first[x]; s < line.first[x + 1]; ++s) {
        std::vector<DeepSample>& pixel = pixels[std::size_t(line.y - window.y0) * std::size_t(window.width()) +
                                                std::size_t(line.x0 - window.x0) + x];
        DeepSample sample;
        sample.index = std::uint32_t(pixel.size());
        sample.front = sample.back = double(values[4][s]);
        sample.opacity = glm::dvec4(double(values[3][s]));
        sample.color = glm::dvec4(double(values[0][s]), double(values[1][s]), double(values[2][s]), 0);
        pixel.push_back(sample);
      }
  });
}

TEST(RealDeep, ThreeElementsMergedGiveTheFlatPictureWhereNoFourthOneLies) {
  const std::string folder = std::string(VARVE_DATA) + "/deep/";
  if (!std::filesystem::exists(folder + "composited.exr")) GTEST_SKIP() << "no " << folder;
  Workers workers;
  const Window window{0, 0, 1024, 576};
  std::vector<std::vector<DeepSample>> pixels(window.pixels());
  for (const char* name : {"Balls", "Leaves", "Trunks"})
    gather_samples(folder + name + ".exr", window, pixels, workers);
  const FileHeader flat = read_header(folder + "composited.exr");
  const Part& part = flat.parts[0];
  std::vector<ChannelRef> channels;
  for (const char* name : {"R", "G", "B", "A"}) channels.push_back({0, 0, *part.channel(name)});
  const FramePixels theirs = read_channels(flat, channels, workers);
  FlattenScratch scratch;
  std::size_t equal = 0;
  const Window& w = part.data_window;
  std::vector<std::vector<float>> rows(4, std::vector<float>(std::size_t(w.width())));
  for (int y = w.y0; y < w.y1; ++y) {
    for (std::size_t k = 0; k < 4; ++k) {
      const RawPlane& plane = theirs[channels[k]];
      to_float(plane.type, plane.row(y - w.y0), rows[k].data(), rows[k].size());
    }
    for (int x = w.x0; x < w.x1; ++x) {
      std::vector<DeepSample>& samples = pixels[std::size_t(y) * 1024 + std::size_t(x)];
      const FlatPixel pixel = samples.empty() ? FlatPixel() : flatten(samples, false, LayerRule::variation, scratch);
      double worst = 0;
      for (int k = 0; k < 4; ++k)
        worst = std::max(worst, std::abs(double(float(half(float(pixel.color[k])))) -
                                         double(rows[std::size_t(k)][std::size_t(x - w.x0)])));
      equal += worst <= 1e-6;
    }
  }
  EXPECT_NEAR(double(equal) / double(w.pixels()), 0.765, 0.001);
}

}  // namespace
}  // namespace varve::test
