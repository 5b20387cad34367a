// Small EXR files of every kind that is read, written by the stock library.
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <array>

#include "fuzz/scratch.h"
#include "fuzz/targets.h"
#include "support/deep_file.h"
#include "unit/exr_test_files.h"

namespace varve::fuzz {
namespace {

constexpr std::array kFlat = {
    Imf::NO_COMPRESSION,    Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,  Imf::PIZ_COMPRESSION,
    Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};

/// An odd data window beside the display window.
Imf::Header header_of(Imf::Compression compression, int width = 21, int height = 35) {
  Imf::Header header(Imath::Box2i({0, 0}, {23, 31}), Imath::Box2i({-3, -2}, {width - 4, height - 3}));
  header.compression() = compression;
  return header;
}

void add(Imf::Header& header, const std::string& layer, std::initializer_list<const char*> names, Imf::PixelType type) {
  for (const char* name : names)
    header.channels().insert(layer.empty() ? name : layer + "." + name, Imf::Channel(type));
}

void add_usual(Imf::Header& header) {
  add(header, "", {"A", "B", "G", "R"}, Imf::HALF);
  add(header, "", {"Z"}, Imf::FLOAT);
  add(header, "velocity", {"x", "y"}, Imf::FLOAT);
  add(header, "", {"id"}, Imf::UINT);
  header.insert("varve:motion", Imf::StringAttribute("varve"));
  header.insert("jitter", Imf::V2fAttribute(Imath::V2f(0.25f, -0.125f)));
}

/// Fills and writes; smooth, so that every compression has something to say.
std::string stock(std::vector<Imf::Header> headers, bool noisy = false) {
  const std::string path = (scratch() / "seed.exr").string();
  test::write_stock(path, std::move(headers), 5, noisy);
  return test::slurp(path);
}

Imf::Header tiled(Imf::Compression compression, Imf::LevelMode mode, Imf::LevelRoundingMode rounding) {
  Imf::Header header = header_of(compression, 19, 13);
  header.setTileDescription(Imf::TileDescription(8, 5, mode, rounding));
  add(header, "", {"B", "G", "R"}, Imf::HALF);
  add(header, "", {"Z"}, Imf::FLOAT);
  return header;
}

std::vector<Imf::Header> several_parts(Imf::Compression compression) {
  std::vector<Imf::Header> headers;
  for (const char* name : {"fg", "bg", "depth"}) {
    headers.push_back(header_of(compression, 11, 9));
    headers.back().setName(name);
    if (name == std::string("depth"))
      add(headers.back(), "", {"Z"}, Imf::FLOAT);
    else
      add(headers.back(), "", {"A", "B", "G", "R"}, Imf::HALF);
  }
  return headers;
}

std::string stereo() {
  std::vector<Imf::Header> headers;
  for (const char* view : {"left", "right"}) {
    headers.push_back(header_of(Imf::ZIP_COMPRESSION, 9, 7));
    headers.back().setName(std::string("rgba.") + view);
    headers.back().setView(view);
    add_usual(headers.back());
  }
  return stock(headers);
}

std::string with_attributes() {
  Imf::Header header = header_of(Imf::ZIPS_COMPRESSION, 8, 6);
  add_usual(header);
  Imath::M44f m;
  m[3][2] = -5;
  header.insert("worldToCamera", Imf::M44fAttribute(m));
  m[2][3] = 1;
  header.insert("worldToNDC", Imf::M44fAttribute(m));
  header.insert("Note", Imf::StringAttribute(R"({"frame":1,"jitter":[0.25,-0.125],"view":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,)"
                                             R"(0,1],"proj":[1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-1,0]})"));
  header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  header.insert(std::string(200, 'n'), Imf::FloatAttribute(1));
  header.channels().insert(std::string(120, 'c') + ".R", Imf::Channel(Imf::HALF));
  return stock({header});
}

std::string subsampled() {
  Imf::Header header(Imath::Box2i({0, 0}, {15, 11}), Imath::Box2i({0, 0}, {15, 11}));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  header.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
  add(header, "", {"R", "G", "B"}, Imf::HALF);
  return stock({header});
}

std::string samples() {
  std::vector<Imf::Header> headers;
  for (int s = 0; s < 2; ++s) {
    headers.push_back(header_of(Imf::ZIP_COMPRESSION, 7, 5));
    headers.back().setName("sample." + std::to_string(s));
    add_usual(headers.back());
  }
  return stock(headers);
}

/// Deep parts with 0 to 3 samples in a pixel.
test::DeepTestPart some_deep(Imf::Compression compression, int tile) {
  test::DeepTestPart part = test::deep_part(11, 7,
                                            {{"R", Imf::HALF},
                                             {"G", Imf::HALF},
                                             {"B", Imf::HALF},
                                             {"A", Imf::HALF},
                                             {"Z", Imf::FLOAT},
                                             {"ZBack", Imf::FLOAT},
                                             {"velocity.x", Imf::FLOAT},
                                             {"velocity.y", Imf::FLOAT},
                                             {"id", Imf::UINT}});
  part.compression = compression;
  part.tile = tile;
  part.data = Imath::Box2i({-2, 1}, {8, 7});
  for (std::size_t p = 0; p < part.pixels(); ++p)
    for (std::size_t s = 0; s < p % 4; ++s) {
      const double v = double(p) / 77 + 0.1 * double(s);
      add_sample(part, p, {v, v / 2, v / 3, 0.5, 4 - double(s), 4.5 - double(s), 1, -0.5, double(p + s)});
    }
  return part;
}

std::string deep_file(std::vector<test::DeepTestPart> parts) {
  const std::string path = (scratch() / "seed.exr").string();
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].name = "part" + std::to_string(i);
  test::write_deep(path, parts);
  return test::slurp(path);
}

}  // namespace

std::vector<std::string> exr_seeds() {
  std::vector<std::string> seeds;
  for (const Imf::Compression compression : kFlat) {
    Imf::Header lines = header_of(compression);
    add_usual(lines);
    seeds.push_back(stock({lines}));
    if (compression >= Imf::PIZ_COMPRESSION) seeds.push_back(stock({lines}, true));
    seeds.push_back(stock({tiled(compression, Imf::ONE_LEVEL, Imf::ROUND_DOWN)}));
    seeds.push_back(stock(several_parts(compression)));
  }
  seeds.push_back(stock({tiled(Imf::ZIP_COMPRESSION, Imf::MIPMAP_LEVELS, Imf::ROUND_UP)}));
  seeds.push_back(stock({tiled(Imf::PIZ_COMPRESSION, Imf::RIPMAP_LEVELS, Imf::ROUND_DOWN)}));
  std::vector<Imf::Header> mixed = several_parts(Imf::ZIP_COMPRESSION);
  mixed.push_back(tiled(Imf::B44_COMPRESSION, Imf::ONE_LEVEL, Imf::ROUND_DOWN));
  seeds.push_back(stock(mixed));
  seeds.push_back(stereo());
  seeds.push_back(with_attributes());
  seeds.push_back(subsampled());
  seeds.push_back(samples());
  return seeds;
}

std::vector<NamedSeed> named_seeds() {
  std::vector<NamedSeed> seeds;
  const auto lines = [&](const char* name, Imf::Compression compression) {
    Imf::Header header = header_of(compression);
    add_usual(header);
    seeds.push_back({name, stock({header})});
  };
  lines("none", Imf::NO_COMPRESSION);
  lines("zip", Imf::ZIP_COMPRESSION);
  lines("piz", Imf::PIZ_COMPRESSION);
  lines("dwaa", Imf::DWAA_COMPRESSION);
  lines("b44", Imf::B44_COMPRESSION);
  lines("pxr24", Imf::PXR24_COMPRESSION);
  seeds.push_back({"tiled", stock({tiled(Imf::ZIP_COMPRESSION, Imf::ONE_LEVEL, Imf::ROUND_DOWN)})});
  seeds.push_back({"parts", stock(several_parts(Imf::ZIP_COMPRESSION))});
  seeds.push_back({"deep", deep_file({some_deep(Imf::NO_COMPRESSION, 0)})});
  seeds.push_back({"deep tiled", deep_file({some_deep(Imf::ZIPS_COMPRESSION, 4)})});
  return seeds;
}

std::vector<std::string> deep_seeds() {
  std::vector<std::string> seeds;
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION})
    for (const int tile : {0, 4}) seeds.push_back(deep_file({some_deep(compression, tile)}));
  seeds.push_back(deep_file({some_deep(Imf::ZIPS_COMPRESSION, 0), some_deep(Imf::NO_COMPRESSION, 4)}));
  test::DeepTestPart flat = test::deep_part(11, 7, {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}});
  for (std::size_t p = 0; p < flat.pixels(); ++p) add_sample(flat, p, {1, 0.5, double(p) / 77});
  flat.flat = true;
  seeds.push_back(deep_file({flat, some_deep(Imf::ZIPS_COMPRESSION, 0)}));
  return seeds;
}

}  // namespace varve::fuzz
