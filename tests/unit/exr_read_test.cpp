// read_header and read_channels against the stock OpenEXR reader.
#include "exr_test_files.h"
#include "paths.h"

namespace varve::test {
namespace {

constexpr Imf::Compression kAll[] = {
    Imf::NO_COMPRESSION,    Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,  Imf::PIZ_COMPRESSION,
    Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};

Imf::Header header_of(Imath::Box2i window, Imf::Compression compression, bool tiled) {
  Imf::Header header(Imath::Box2i({0, 0}, {63, 47}), window);
  header.compression() = compression;
  header.channels().insert("B", Imf::Channel(Imf::HALF));
  header.channels().insert("G", Imf::Channel(Imf::HALF));
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  header.channels().insert("object id", Imf::Channel(Imf::UINT));
  if (tiled) header.setTileDescription(Imf::TileDescription(16, 8, Imf::MIPMAP_LEVELS));
  return header;
}

const Imath::Box2i kWindows[] = {{{0, 0}, {0, 0}},      {{0, 0}, {0, 32}},       {{-7, -5}, {23, 11}},
                                 {{100, 3}, {163, 19}}, {{-40, -300}, {-1, -1}}, {{5, 5}, {36, 5}}};

TEST(ReadChannels, EqualsTheStockReaderForEveryCompressionAndWindow) {
  Folder folder;
  Workers workers(2);
  for (const Imath::Box2i& window : kWindows)
    for (Imf::Compression compression : kAll)
      for (bool tiled : {false, true})
        for (bool noisy : {false, true}) {
          const std::string path = folder / "in.exr";
          write_stock(path, {header_of(window, compression, tiled)}, 3, noisy);
          const FileHeader header = read_header(path);
          const std::string what = std::string(name_of(header.parts[0].compression)) + (tiled ? " tiled " : " ") +
                                   std::to_string(window.size().x + 1) + "x" + std::to_string(window.size().y + 1);
          EXPECT_EQ(int(header.parts[0].compression), int(compression));
          EXPECT_EQ(header.parts[0].data_window,
                    (Window{window.min.x, window.min.y, window.max.x + 1, window.max.y + 1}));
          EXPECT_EQ(header.parts[0].storage, tiled ? Storage::tiled : Storage::scanline);
          expect_equal(header, read_channels(header, all_flat_channels(header), workers), read_stock(path), what);
        }
}

TEST(ReadChannels, LosslessBitsAreThoseWritten) {
  Folder folder;
  Workers workers(2);
  for (Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    const std::string path = folder / "in.exr";
    // Two single parts in one file, of different windows and kinds.
    const auto written = write_stock(
        path, {header_of({{-3, 2}, {28, 40}}, compression, false), header_of({{0, 0}, {40, 20}}, compression, true)});
    const FileHeader header = read_header(path);
    expect_equal(header, read_channels(header, all_flat_channels(header), workers), written, "two parts");
  }
}

TEST(ReadChannels, SubsampledChannelsKeepTheirOwnSize) {
  Folder folder;
  Workers workers(2);
  for (Imf::Compression compression : kAll) {
    Imf::Header header(Imath::Box2i({0, 0}, {63, 47}), Imath::Box2i({-4, -6}, {27, 35}));
    header.compression() = compression;
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 4, 2));
    const std::string path = folder / "in.exr";
    write_stock(path, {header});
    const FileHeader ours = read_header(path);
    expect_equal(ours, read_channels(ours, all_flat_channels(ours), workers), read_stock(path), "subsampled");
  }
}

TEST(ReadChannels, OnlyTheChosenChannelsAreRead) {
  Folder folder;
  Workers workers(1);
  const std::string path = folder / "in.exr";
  const auto written = write_stock(path,
                                   {header_of({{0, 0}, {40, 40}}, Imf::ZIP_COMPRESSION, false),
                                    header_of({{0, 0}, {40, 40}}, Imf::ZIP_COMPRESSION, false)},
                                   1, false);
  // The second part (compressed, so that damage shows) is destroyed: a part without a chosen channel is not touched.
  std::string bytes = slurp(path);
  for (std::size_t i = bytes.size() - 4000; i < bytes.size(); ++i) bytes[i] = 0x55;
  spill(path, bytes);
  const FileHeader header = read_header(path);
  const ChannelRef z{0, 0, *header.parts[0].channel("Z")};
  const FramePixels frame = read_channels(header, std::vector{z}, workers);
  EXPECT_EQ(packed(frame[z]), written[0].at("Z").bytes);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t c = 0; c < 5; ++c) EXPECT_EQ(frame.planes[p][c].empty(), !(p == 0 && int(c) == z.channel));
  EXPECT_EQ(failure_of([&] { read_channels(header, all_flat_channels(header), workers); }).code(), ExitCode::input);
}

TEST(ReadChannels, RealFilesEqualTheStockReader) {
  const std::string data = VARVE_DATA;
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no " << data;
  Workers workers(2);
  for (const char* name : {"beachball/singlepart.0001.exr", "samples4/jit/frame.0009.exr", "extremes/AllHalfValues.exr",
                           "extremes/WideFloatRange.exr", "extremes/BrightRingsNanInf.exr",
                           "courtyard/jit/frame.0001.exr", "deep/composited.exr", "layers/jit/frame.0003.exr"}) {
    const FileHeader header = read_header(data + "/" + name);
    expect_equal(header, read_channels(header, all_flat_channels(header), workers), read_stock(header.path), name);
  }
  const FileHeader ball = read_header(data + "/beachball/singlepart.0001.exr");
  EXPECT_EQ(ball.multi_view, (std::vector<std::string>{"right", "left"}));
  EXPECT_EQ(ball.parts[0].data_window, (Window{654, 245, 1565, 1121}));
  const FileHeader deep = read_header(data + "/deep/Balls.exr");
  EXPECT_EQ(deep.parts[0].storage, Storage::deep_scanline);
  EXPECT_EQ(deep.parts[0].name, "rgba.left");
  EXPECT_EQ(failure_of([&] {
              read_channels(deep, std::vector{ChannelRef{0, 0, 0}}, workers);
            }).code(),
            ExitCode::inconsistent);
}

}  // namespace
}  // namespace varve::test
