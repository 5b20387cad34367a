// Damaged and lying files end in a sentence or in pixels, never in a crash, a hang or a huge allocation.
#include <sys/resource.h>

#include <ctime>

#include <OpenEXR/ImfStandardAttributes.h>

#include "exr/write_frame.h"
#include "exr_test_files.h"

namespace varve::test {
namespace {

Imf::Header header_of(Imf::Compression compression, bool tiled = false) {
  Imf::Header header(Imath::Box2i({0, 0}, {31, 31}), Imath::Box2i({-3, 0}, {28, 36}));
  header.compression() = compression;
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  if (tiled) header.setTileDescription(Imf::TileDescription(16, 8, Imf::MIPMAP_LEVELS));
  return header;
}

/// Reads all that can be read and copies every part; true if nothing was refused.
bool use(const std::string& path, const std::string& copy, Workers& workers) {
  try {
    const FileHeader header = read_header(path);
    std::vector<OutputPart> parts(header.parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i].source_part = int(i);
      parts[i].copy_chunks = true;
    }
    const FramePixels frame = read_channels(header, all_flat_channels(header), workers);
    write_frame(copy, header, parts, {}, workers);
    return true;
  } catch (const Failure& failure) {
    EXPECT_FALSE(std::string(failure.what()).empty());
    EXPECT_EQ(std::string(failure.what()).find("rror"), std::string::npos) << failure.what();
    return false;
  }
}

std::vector<std::string> small_files(const Folder& folder) {
  std::vector<std::string> paths;
  for (Imf::Compression c : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
                             Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
    for (int kind : {0, 1, 2}) {
      paths.push_back(folder / ("in" + std::to_string(c) + std::to_string(kind) + ".exr"));
      std::vector<Imf::Header> headers{header_of(c, kind == 1)};
      if (kind == 2) headers.push_back(header_of(c, true));
      write_stock(paths.back(), headers, 4, false);
    }
  return paths;
}

TEST(HostileFiles, TruncationAnywhereIsRefused) {
  Folder folder;
  Workers workers(2);
  for (const std::string& path : small_files(folder)) {
    const std::string bytes = slurp(path);
    ASSERT_TRUE(use(path, folder / "copy.exr", workers)) << path;
    for (int i = 0; i < 50; ++i) {
      const std::size_t length = bytes.size() * std::size_t(i) / 50;
      spill(folder / "cut.exr", bytes.substr(0, length));
      EXPECT_FALSE(use(folder / "cut.exr", folder / "copy.exr", workers)) << path << " at " << length;
    }
    spill(folder / "cut.exr", bytes.substr(0, bytes.size() - 1));
    EXPECT_FALSE(use(folder / "cut.exr", folder / "copy.exr", workers)) << path;
  }
}

TEST(HostileFiles, FlippedBytesNeverCrash) {
  Folder folder;
  Workers workers(2);
  std::mt19937 random(20260801);
  int refused = 0, total = 0;
  for (const std::string& path : small_files(folder)) {
    const std::string bytes = slurp(path);
    for (int i = 0; i < 60; ++i, ++total) {
      std::string damaged = bytes;
      // Half of the damage goes into headers and tables, where it hurts most.
      const std::size_t reach = i % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 800);
      for (int n = 0; n <= i % 3; ++n) damaged[random() % reach] = char(random());
      spill(folder / "bad.exr", damaged);
      refused += !use(folder / "bad.exr", folder / "copy.exr", workers);
    }
  }
  EXPECT_GT(refused, total / 4);
}

TEST(HostileFiles, WhatIsNoExrIsSaidToBeNone) {
  Folder folder;
  spill(folder / "empty.exr", "");
  spill(folder / "text.exr", "this is not a picture at all");
  std::mt19937 random(7);
  std::string noise(5000, '\0');
  for (char& c : noise) c = char(random());
  spill(folder / "noise.exr", noise);
  spill(folder / "noisy header.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) + noise);
  for (const char* name : {"empty.exr", "text.exr", "noise.exr", "noisy header.exr", "missing.exr", "."}) {
    const Failure failure = failure_of([&] { read_header(folder / name); });
    EXPECT_EQ(failure.code(), ExitCode::input);
    EXPECT_NE(std::string(failure.what()).find(folder / name), std::string::npos) << failure.what();
  }
}

/// Replaces the 16 bytes of a box in the header.
std::string with_window(std::string bytes, const char* name, std::vector<std::int32_t> box) {
  const std::size_t at = bytes.find(std::string(name) + '\0' + "box2i") + std::strlen(name) + 1 + 6 + 4;
  std::memcpy(bytes.data() + at, box.data(), 16);
  return bytes;
}

TEST(HostileFiles, LyingWindowsAreRefusedBeforeAnythingIsAllocated) {
  Folder folder;
  Workers workers(1);
  constexpr std::int32_t big = 2147483647;
  const std::vector<std::vector<std::int32_t>> boxes = {
      {0, 0, big, big}, {-big - 1, -big - 1, big, big}, {0, 0, 30000, 30000}, {0, 0, 1000000, 400}, {5, 5, 4, 4},
      {0, 0, -1, 31},   {big, big, big, big},           {0, 0, 16383, 8191}};
  for (Imf::Compression c : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION})
    for (bool tiled : {false, true}) {
      write_stock(folder / "in.exr", {header_of(c, tiled)}, 4, false);
      rusage before{}, after{};
      getrusage(RUSAGE_SELF, &before);
      for (const auto& box : boxes) {
        spill(folder / "bad.exr", with_window(slurp(folder / "in.exr"), "dataWindow", box));
        EXPECT_FALSE(use(folder / "bad.exr", folder / "copy.exr", workers)) << box[2] << " " << box[3];
      }
      getrusage(RUSAGE_SELF, &after);
      EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200 * 1024) << "KiB";
    }
}

TEST(HostileFiles, LimitsHold) {
  Folder folder;
  write_stock(folder / "in.exr", {header_of(Imf::ZIP_COMPRESSION), header_of(Imf::ZIP_COMPRESSION, true)});
  const auto refused = [&](const ReadLimits& limits) {
    return failure_of([&] { read_header(folder / "in.exr", limits); }).code() == ExitCode::input;
  };
  ReadLimits limits;
  EXPECT_NO_THROW(read_header(folder / "in.exr", limits));
  limits.pixels_per_part = 32 * 37 - 1;
  EXPECT_TRUE(refused(limits));
  limits = {}, limits.edge = 36;
  EXPECT_TRUE(refused(limits));
  limits = {}, limits.tile_pixels = 127;
  EXPECT_TRUE(refused(limits));
  limits = {}, limits.parts = 1;
  EXPECT_TRUE(refused(limits));
  limits = {}, limits.channels = 1;
  EXPECT_TRUE(refused(limits));
  limits = {}, limits.inflation = 0.1;
  EXPECT_TRUE(refused(limits));
}

TEST(HostileFiles, ConstantPicturesAreNoBombs) {
  // What compresses best must not be taken for a lie.
  Folder folder;
  Workers workers(2);
  for (Imf::Compression c :
       {Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION,
        Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    Imf::Header header(3840, 2160);
    header.compression() = c;
    for (const char* name : {"A", "B", "G", "R", "Z", "u", "v", "w"})
      header.channels().insert(name, Imf::Channel(Imf::HALF));
    PartPixels black;
    const Imf::FrameBuffer frame = frame_for(header, black);
    {
      Imf::MultiPartOutputFile file((folder / "in.exr").c_str(),
                                    [&] {
                                      header.setType(Imf::SCANLINEIMAGE);
                                      return &header;
                                    }(),
                                    1);
      Imf::OutputPart part(file, 0);
      part.setFrameBuffer(frame);
      part.writePixels(2160);
    }
    const FileHeader ours = read_header(folder / "in.exr");
    const ChannelRef red{0, 0, 3};
    EXPECT_EQ(packed(read_channels(ours, std::vector{red}, workers)[red]), black.at("R").bytes) << c;
  }
}

TEST(HostileFiles, ManyAttributesTakeTimeInStepWithTheirNumber) {
  // With a search through all names for each, these took 12 s.
  Folder folder;
  std::vector<Imf::Header> headers;
  for (int p = 0; p < 2; ++p) headers.push_back(header_of(Imf::NO_COMPRESSION));
  write_stock(folder / "in.exr", headers);
  std::string bytes = slurp(folder / "in.exr"), many;
  for (int i = 0; i < 16000; ++i) many += "a" + std::to_string(i) + std::string("\0int\0\0\0\0\0", 9);
  many += std::string("a7\0int\0\4\0\0\0\7\0\0\0", 15);  // again: the last one counts
  bytes.insert(8, many);
  spill(folder / "many.exr", bytes);
  const std::clock_t begin = std::clock();
  // The tables no longer say where the chunks are, which a header does not ask.
  const FileHeader header = read_header(folder / "many.exr");
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 0.5);
  EXPECT_GT(header.parts[0].attributes.size(), 16000u);
  ASSERT_TRUE(header.parts[0].attribute("a7"));
  EXPECT_EQ(header.parts[0].attribute("a7")->numbers, std::vector<double>{7});
}

TEST(HostileFiles, MissingChunksAndChangedFilesAreTold) {
  Folder folder;
  Workers workers(2);
  write_stock(folder / "in.exr", {header_of(Imf::ZIP_COMPRESSION)}, 4, false);
  const FileHeader header = read_header(folder / "in.exr");
  std::string bytes = slurp(folder / "in.exr");
  // The table of three chunks is the last thing before the first chunk, whose place it names.
  std::size_t table = 0;
  for (std::size_t i = 8; i + 24 < bytes.size() && table == 0; ++i) {
    std::uint64_t first;
    std::memcpy(&first, bytes.data() + i, 8);
    if (first == i + 24) table = i;
  }
  ASSERT_GT(table, 0u);
  std::memset(bytes.data() + table + 8, 0, 8);
  spill(folder / "in.exr", bytes);
  const auto read = [&] { read_channels(header, all_flat_channels(header), workers); };
  const Failure missing = failure_of(read);
  EXPECT_EQ(missing.code(), ExitCode::input);
  EXPECT_NE(std::string(missing.what()).find("incomplete"), std::string::npos) << missing.what();

  write_stock(folder / "in.exr", {header_of(Imf::PIZ_COMPRESSION)});
  EXPECT_EQ(failure_of(read).code(), ExitCode::inconsistent);
}

}  // namespace
}  // namespace varve::test
