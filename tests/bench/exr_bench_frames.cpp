// Frames for the benchmarks: the small courtyard render laid side by side up to 1920x1080.
//   exr_bench_frames COURTYARD/frame.0001.exr OUT.exr fat|lean none|zips|zip|piz
// fat: RGBA half, Z float, velocity XYZW float, normal half, two color layers half: 18 channels, 46 bytes a pixel.
// lean: RGBA half, Z float, velocity.x/y half: 16 bytes a pixel. No two tiles are alike: each has noise of its own.
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

namespace {

constexpr int kWidth = 1920, kHeight = 1080;

struct Source {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> planes;
};

Source read(const char* path) {
  Imf::InputFile in(path);
  const Imath::Box2i window = in.header().dataWindow();
  Source source{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
  Imf::FrameBuffer frame;
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) {
    std::vector<float>& plane = source.planes[c.name()];
    plane.resize(std::size_t(source.width) * std::size_t(source.height));
    frame.insert(c.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float)));
  }
  in.setFrameBuffer(frame);
  in.readPixels(window.min.y, window.max.y);
  return source;
}

// A few percent, different in every pixel, so that a repeated tile is no repeated string to the compressor.
float grain(std::uint32_t pixel) {
  pixel = (pixel ^ (pixel >> 16)) * 0x7feb352du;
  pixel = (pixel ^ (pixel >> 15)) * 0x846ca68bu;
  return 1.0f + 0.05f * (float((pixel >> 8) & 0xffff) / 65535.0f - 0.5f);
}

struct Target {
  const char *name, *from;
  Imf::PixelType type;
};

const std::vector<Target> kLean = {
    {"R", "ViewLayer.Combined.R", Imf::HALF},        {"G", "ViewLayer.Combined.G", Imf::HALF},
    {"B", "ViewLayer.Combined.B", Imf::HALF},        {"A", "ViewLayer.Combined.A", Imf::HALF},
    {"Z", "ViewLayer.Depth.Z", Imf::FLOAT},          {"velocity.x", "ViewLayer.Vector.X", Imf::HALF},
    {"velocity.y", "ViewLayer.Vector.Y", Imf::HALF},
};
const std::vector<Target> kFat = {
    {"R", "ViewLayer.Combined.R", Imf::HALF},         {"G", "ViewLayer.Combined.G", Imf::HALF},
    {"B", "ViewLayer.Combined.B", Imf::HALF},         {"A", "ViewLayer.Combined.A", Imf::HALF},
    {"Z", "ViewLayer.Depth.Z", Imf::FLOAT},           {"velocity.X", "ViewLayer.Vector.X", Imf::FLOAT},
    {"velocity.Y", "ViewLayer.Vector.Y", Imf::FLOAT}, {"velocity.Z", "ViewLayer.Vector.Z", Imf::FLOAT},
    {"velocity.W", "ViewLayer.Vector.W", Imf::FLOAT}, {"N.X", "ViewLayer.Normal.X", Imf::HALF},
    {"N.Y", "ViewLayer.Normal.Y", Imf::HALF},         {"N.Z", "ViewLayer.Normal.Z", Imf::HALF},
    {"diffuse.R", "ViewLayer.Combined.R", Imf::HALF}, {"diffuse.G", "ViewLayer.Combined.G", Imf::HALF},
    {"diffuse.B", "ViewLayer.Combined.B", Imf::HALF}, {"glossy.R", "ViewLayer.Combined.R", Imf::HALF},
    {"glossy.G", "ViewLayer.Combined.G", Imf::HALF},  {"glossy.B", "ViewLayer.Combined.B", Imf::HALF},
};

void write(const Source& source, const char* path, const std::vector<Target>& targets, Imf::Compression compression) {
  Imf::Header header(kWidth, kHeight);
  header.compression() = compression;
  Imf::FrameBuffer frame;
  std::vector<std::vector<float>> floats(targets.size());
  std::vector<std::vector<half>> halves(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    header.channels().insert(targets[t].name, Imf::Channel(targets[t].type));
    const std::vector<float>& from = source.planes.at(targets[t].from);
    const bool grained = std::string(targets[t].name) != "A" && std::string(targets[t].name) != "Z";
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t i =
            std::size_t(y % source.height) * std::size_t(source.width) + std::size_t(x % source.width);
        const std::uint32_t seed = (std::uint32_t(t) * kHeight + std::uint32_t(y)) * kWidth + std::uint32_t(x);
        const float value = from[i] * (grained ? grain(seed) : 1.0f);
        if (targets[t].type == Imf::HALF)
          halves[t].push_back(half(value));
        else
          floats[t].push_back(value);
      }
    char* base = targets[t].type == Imf::HALF ? reinterpret_cast<char*>(halves[t].data())
                                              : reinterpret_cast<char*>(floats[t].data());
    const std::size_t size = targets[t].type == Imf::HALF ? 2 : 4;
    frame.insert(targets[t].name, Imf::Slice(targets[t].type, base, size, size * kWidth));
  }
  Imf::OutputFile out(path, header);
  out.setFrameBuffer(frame);
  out.writePixels(kHeight);
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, Imf::Compression> compressions = {{"none", Imf::NO_COMPRESSION},
                                                                {"zips", Imf::ZIPS_COMPRESSION},
                                                                {"zip", Imf::ZIP_COMPRESSION},
                                                                {"piz", Imf::PIZ_COMPRESSION}};
  if (argc != 5 || !compressions.count(argv[4])) {
    std::fprintf(stderr, "usage: %s COURTYARD/frame.0001.exr OUT.exr fat|lean none|zips|zip|piz\n", argv[0]);
    return 2;
  }
  try {
    write(read(argv[1]), argv[2], std::string(argv[3]) == "fat" ? kFat : kLean, compressions.at(argv[4]));
  } catch (const std::exception& caught) {
    std::fprintf(stderr, "%s\n", caught.what());
    return 1;
  }
  return 0;
}
