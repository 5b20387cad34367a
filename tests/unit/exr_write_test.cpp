// write_frame: what comes out is what went in, read by the stock OpenEXR reader.
#include "exr/write_frame.h"

#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfPreviewImageAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>

#include "exr/container.h"
#include "exr_test_files.h"
#include "paths.h"

namespace {
/// A type of attribute that no reader knows.
struct Studio {
  unsigned char bytes[5];
};
}  // namespace
using StudioAttribute = Imf::TypedAttribute<Studio>;
namespace OPENEXR_IMF_INTERNAL_NAMESPACE {
template <>
const char* StudioAttribute::staticTypeName() {
  return "studioType";
}
template <>
void StudioAttribute::writeValueTo(OStream& os, int) const {
  os.write(reinterpret_cast<const char*>(_value.bytes), 5);
}
template <>
void StudioAttribute::readValueFrom(IStream&, int, int) {}
}  // namespace OPENEXR_IMF_INTERNAL_NAMESPACE

namespace varve::test {
namespace {

constexpr Imf::Compression kLossless[] = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                          Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION};

Imf::Header header_of(Imath::Box2i window, Imf::Compression compression, bool tiled = false) {
  Imf::Header header(Imath::Box2i({0, 0}, {63, 47}), window);
  header.compression() = compression;
  header.channels().insert("B", Imf::Channel(Imf::HALF));
  header.channels().insert("R", Imf::Channel(Imf::HALF, 1, 1, true));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  header.channels().insert("a layer with a very long name indeed.object id", Imf::Channel(Imf::UINT));
  if (tiled) header.setTileDescription(Imf::TileDescription(16, 8, Imf::RIPMAP_LEVELS));
  return header;
}

/// Every part of the source, decoded and written again.
std::vector<OutputPart> rewrite_all(const FileHeader& header, const FramePixels& frame) {
  std::vector<OutputPart> parts(header.parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    parts[p].source_part = int(p);
    parts[p].copy_chunks = is_deep(header.parts[p]);
    for (std::size_t c = 0; !parts[p].copy_chunks && c < header.parts[p].channels.size(); ++c)
      parts[p].channels.push_back({header.parts[p].channels[c], &frame.planes[p][c]});
  }
  return parts;
}

void rewrite(const std::string& from, const std::string& to, Workers& workers) {
  const FileHeader header = read_header(from);
  const FramePixels frame = read_channels(header, all_flat_channels(header), workers);
  write_frame(to, header, rewrite_all(header, frame), {}, workers);
}

TEST(WriteFrame, RoundTripKeepsEveryBit) {
  Folder folder;
  Workers workers(2);
  const Imath::Box2i windows[] = {{{0, 0}, {0, 0}}, {{-7, -5}, {23, 11}}, {{3, 4}, {3, 40}}, {{-70, -300}, {-1, -1}}};
  for (Imf::Compression compression : kLossless)
    for (const Imath::Box2i& window : windows)
      for (bool noisy : {false, true})
        for (int parts : {1, 2}) {
          std::vector<Imf::Header> headers{header_of(window, compression)};
          if (parts == 2) headers.push_back(header_of({{1, 1}, {20, 40}}, compression, true));
          const auto written = write_stock(folder / "in.exr", headers, 5, noisy);
          rewrite(folder / "in.exr", folder / "out.exr", workers);
          EXPECT_TRUE(read_stock(folder / "out.exr") == written) << compression << " " << window.min.x << " " << parts;
          const FileHeader out = read_header(folder / "out.exr");
          for (const Part& part : out.parts) {
            EXPECT_EQ(int(part.compression), int(compression));
            EXPECT_EQ(part.storage, Storage::scanline);
          }
          EXPECT_TRUE(out.parts[0].channels[1].perceptually_linear);
        }
}

TEST(WriteFrame, SubsampledChannelsComeBack) {
  Folder folder;
  Workers workers(2);
  for (Imf::Compression compression : kLossless) {
    Imf::Header header(Imath::Box2i({0, 0}, {63, 47}), Imath::Box2i({-4, -6}, {27, 35}));
    header.compression() = compression;
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 4, 2));
    const auto written = write_stock(folder / "in.exr", {header});
    rewrite(folder / "in.exr", folder / "out.exr", workers);
    EXPECT_TRUE(read_stock(folder / "out.exr") == written) << compression;
  }
}

TEST(WriteFrame, AttributesOfEveryTypeSurvive) {
  Folder folder;
  Workers workers(2);
  Imf::Header header = header_of({{0, 0}, {30, 30}}, Imf::ZIP_COMPRESSION);
  header.insert("an attribute with a name beyond thirty-one letters", Imf::IntAttribute(-7));
  header.insert("empty", Imf::StringAttribute(""));
  header.insert("text", Imf::StringAttribute(std::string("two\0parts", 9)));
  header.insert("views", Imf::StringVectorAttribute({"left", "", "right"}));
  header.insert("matrix", Imf::M44fAttribute(Imath::M44f(2)));
  header.insert("matrix3", Imf::M33dAttribute(Imath::M33d(3)));
  header.insert("box", Imf::Box2fAttribute({{-1, -2}, {3, 4}}));
  header.insert("rate", Imf::RationalAttribute(Imf::Rational(24000, 1001)));
  header.insert("opaque", StudioAttribute(Studio{{1, 0, 255, 127, 2}}));
  Imf::PreviewRgba preview[6];
  preview[4].r = 77;
  header.setPreviewImage(Imf::PreviewImage(3, 2, preview));
  addTimeCode(header, Imf::TimeCode(1, 2, 3, 4));
  addKeyCode(header, Imf::KeyCode(1, 2, 3, 4, 5));
  addChromaticities(header, Imf::Chromaticities());
  header.lineOrder() = Imf::DECREASING_Y;
  header.pixelAspectRatio() = 2;
  write_stock(folder / "in.exr", {header});
  const FileHeader source = read_header(folder / "in.exr");
  const FramePixels frame = read_channels(source, all_flat_channels(source), workers);
  WriteOptions options;
  options.attributes = {{"varveVersion", "1.2"}};
  write_frame(folder / "out.exr", source, rewrite_all(source, frame), options, workers);

  const Container in = open_container(InputBytes(folder / "in.exr")),
                  out = open_container(InputBytes(folder / "out.exr"));
  ASSERT_EQ(out.raw[0].attributes.size(), in.raw[0].attributes.size() + 1);
  for (std::size_t i = 0; i < in.raw[0].attributes.size(); ++i) {
    const RawAttribute &a = in.raw[0].attributes[i], &b = out.raw[0].attributes[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(b.value, a.name == "lineOrder" ? std::string(1, '\0') : a.value) << a.name;
  }
  const Part& part = out.header.parts[0];
  EXPECT_EQ(part.attribute("varveVersion")->text, "1.2");
  EXPECT_EQ(part.attribute("rate")->numbers, (std::vector<double>{24000, 1001}));
  EXPECT_EQ(part.attribute("box")->numbers, (std::vector<double>{-1, -2, 3, 4}));
  EXPECT_EQ(part.attribute("views")->text, "left, , right");
  EXPECT_EQ(part.attribute("opaque")->type, "studioType");
  EXPECT_EQ(part.attribute("matrix")->numbers[5], 2);
  // The stock reader takes it as well.
  Imf::MultiPartInputFile stock((folder / "out.exr").c_str());
  EXPECT_EQ(stock.header(0).previewImage().pixels()[4].r, 77);
  EXPECT_EQ(stock.header(0).lineOrder(), Imf::INCREASING_Y);
}

TEST(WriteFrame, BytesDoNotDependOnTheNumberOfWorkers) {
  Folder folder;
  Workers one(1), many(5);
  for (Imf::Compression compression : kLossless) {
    write_stock(folder / "in.exr", {header_of({{-3, -3}, {200, 170}}, compression)}, 9, false);
    rewrite(folder / "in.exr", folder / "one.exr", one);
    rewrite(folder / "in.exr", folder / "many.exr", many);
    EXPECT_TRUE(slurp(folder / "one.exr") == slurp(folder / "many.exr")) << compression;
  }
}

/// Coordinates and bytes of every chunk of a part, without part numbers and offsets.
std::vector<std::string> chunk_contents(const std::string& path, int part) {
  const Container file = open_container(InputBytes(path));
  std::vector<std::uint64_t> starts, ends{file.file.size()};
  for (std::size_t p = 0; p < file.raw.size(); ++p)
    for (std::uint64_t offset : read_chunk_table(file, int(p))) ends.push_back(offset);
  std::vector<std::string> contents;
  for (std::uint64_t offset : read_chunk_table(file, part)) {
    std::uint64_t end = file.file.size();
    for (std::uint64_t e : ends)
      if (e > offset && e < end) end = e;
    offset += file.multi_part ? 4 : 0;
    contents.emplace_back(end - offset, '\0');
    file.file.read(offset, contents.back().data(), contents.back().size(), "chunk");
  }
  return contents;
}

TEST(WriteFrame, CopiedPartsAreBitIdenticalBesideRewrittenOnes) {
  Folder folder;
  Workers workers(2);
  std::vector<Imf::Header> headers{header_of({{0, 0}, {33, 50}}, Imf::ZIP_COMPRESSION),
                                   header_of({{-5, 0}, {33, 50}}, Imf::PIZ_COMPRESSION, true),
                                   header_of({{0, 0}, {33, 70}}, Imf::DWAB_COMPRESSION)};
  headers[2].lineOrder() = Imf::DECREASING_Y;
  const auto written = write_stock(folder / "in.exr", headers, 11, false);
  const FileHeader source = read_header(folder / "in.exr");
  const FramePixels frame = read_channels(source, all_flat_channels(source), workers);
  auto parts = rewrite_all(source, frame);
  parts[1].copy_chunks = parts[2].copy_chunks = true;
  write_frame(folder / "out.exr", source, parts, {}, workers);
  EXPECT_TRUE(read_stock(folder / "out.exr") == read_stock(folder / "in.exr"));
  for (int p : {1, 2}) EXPECT_TRUE(chunk_contents(folder / "out.exr", p) == chunk_contents(folder / "in.exr", p));

  // A tiled part alone in its file, and reordered parts.
  write_frame(folder / "alone.exr", source, std::vector{parts[1]}, {}, workers);
  EXPECT_TRUE(read_stock(folder / "alone.exr")[0] == written[1]);
  EXPECT_TRUE(chunk_contents(folder / "alone.exr", 0) == chunk_contents(folder / "in.exr", 1));
  write_frame(folder / "turned.exr", source, std::vector{parts[2], parts[0]}, {}, workers);
  EXPECT_TRUE(read_stock(folder / "turned.exr")[1] == written[0]);
}

TEST(WriteFrame, DeepPartsAreCopiedAsTheyAre) {
  const std::string path = std::string(VARVE_DATA) + "/deep/Balls.exr";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  Folder folder;
  Workers workers(2);
  const FileHeader source = read_header(path);
  std::vector<OutputPart> parts(1);
  parts[0].copy_chunks = true;
  write_frame(folder / "out.exr", source, parts, {}, workers);
  EXPECT_TRUE(slurp(folder / "out.exr") == slurp(path));
}

TEST(WriteFrame, CompressionIsKeptWhenLosslessAndChosenSafely) {
  Folder folder;
  Workers workers(2);
  for (Imf::Compression lossy : {Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION,
                                 Imf::DWAB_COMPRESSION, Imf::PXR24_COMPRESSION}) {
    write_stock(folder / "in.exr", {header_of({{0, 0}, {40, 40}}, lossy)}, 2, false);
    const FileHeader source = read_header(folder / "in.exr");
    const FramePixels frame = read_channels(source, all_flat_channels(source), workers);
    auto parts = rewrite_all(source, frame);
    write_frame(folder / "out.exr", source, parts, {}, workers);
    EXPECT_EQ(read_header(folder / "out.exr").parts[0].compression, Compression::zip);
    EXPECT_TRUE(read_stock(folder / "out.exr") == read_stock(folder / "in.exr"));
    // The uint channel makes lossy compression a mistake; without it the request is met.
    parts[0].compression = Compression(int(lossy));
    EXPECT_EQ(failure_of([&] { write_frame(folder / "bad.exr", source, parts, {}, workers); }).code(), ExitCode::usage);
    parts[0].channels.pop_back();
    write_frame(folder / "out.exr", source, parts, {}, workers);
    EXPECT_EQ(int(read_header(folder / "out.exr").parts[0].compression), int(lossy));
    EXPECT_EQ(read_stock(folder / "out.exr")[0].size(), 3u);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.exr"));
}

TEST(WriteFrame, NothingHalfDoneIsLeftBehind) {
  Folder folder;
  Workers workers(2);
  write_stock(folder / "in.exr", {header_of({{0, 0}, {40, 400}}, Imf::ZIP_COMPRESSION)}, 2, false);
  const FileHeader source = read_header(folder / "in.exr");
  spill(folder / "out.exr", "what was there before");
  // The source is cut while its chunks are copied.
  std::string bytes = slurp(folder / "in.exr");
  spill(folder / "in.exr", bytes.substr(0, bytes.size() / 2));
  std::vector<OutputPart> parts(1);
  parts[0].copy_chunks = true;
  EXPECT_EQ(failure_of([&] { write_frame(folder / "out.exr", source, parts, {}, workers); }).code(), ExitCode::input);
  EXPECT_EQ(slurp(folder / "out.exr"), "what was there before");
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path)) ++files;
  EXPECT_EQ(files, 2);

  EXPECT_EQ(failure_of([&] { write_frame(folder / "none/out.exr", source, parts, {}, workers); }).code(),
            ExitCode::output);
  EXPECT_EQ(failure_of([&] { check_writable(folder.path.string()); }).code(), ExitCode::output);
  EXPECT_EQ(failure_of([&] { check_writable(folder / "in.exr/x.exr"); }).code(), ExitCode::output);
  check_writable(folder / "new.exr");
}

TEST(WriteFrame, RequestsThatMakeNoFileAreRefused) {
  Folder folder;
  Workers workers(1);
  write_stock(folder / "in.exr", {header_of({{0, 0}, {9, 9}}, Imf::ZIP_COMPRESSION)});
  const FileHeader source = read_header(folder / "in.exr");
  const FramePixels frame = read_channels(source, all_flat_channels(source), workers);
  const auto good = rewrite_all(source, frame);
  const auto code = [&](const std::vector<OutputPart>& parts) {
    return failure_of([&] { write_frame(folder / "out.exr", source, parts, {}, workers); }).code();
  };
  auto twice = good, shallow = good, none = good;
  twice[0].channels.push_back(twice[0].channels[0]);
  const RawPlane small = make_raw_plane(PixelType::float16, Window{0, 0, 9, 10});
  shallow[0].channels[0].pixels = &small;
  none[0].channels.clear();
  EXPECT_EQ(code({}), ExitCode::output);
  EXPECT_EQ(code(twice), ExitCode::output);
  EXPECT_EQ(code(shallow), ExitCode::output);
  EXPECT_EQ(code(none), ExitCode::output);
  EXPECT_EQ(code({good[0], good[0]}), ExitCode::output);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace
}  // namespace varve::test
