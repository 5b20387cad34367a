// varve_cut_sequence IN.exr OUT.exr CHANNEL...
// One frame with only the channels named and every attribute it had. Float channels are rounded so that they pack well:
// depth (".Z" of a Depth layer) to 16 significant bits, everything else to 1/4096. Half channels stay as they are.
// This made sequences/courtyard; see sequences/README.md.

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

namespace {

constexpr float kBackground = 1e10f;  // Cycles writes it where nothing is hit; kept exactly

/// Nearest float with a significand of 16 bits (15 stored), ties away from zero.
float rounded_depth(float value) {
  if (!std::isfinite(value) || value >= kBackground) return value;
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value) + 0x80u) & ~0xffu);
}

float rounded_vector(float value) { return std::isfinite(value) ? std::round(value * 4096.f) / 4096.f : value; }

bool is_depth(const std::string& channel) { return channel.ends_with("Depth.Z"); }

void cut(const std::string& from, const std::string& to, const std::vector<std::string>& names) {
  Imf::InputFile input(from.c_str());
  Imf::Header header = input.header();
  const Imath::Box2i window = header.dataWindow();
  const std::size_t width = std::size_t(window.max.x - window.min.x + 1);
  const std::size_t pixels = width * std::size_t(window.max.y - window.min.y + 1);

  std::map<std::string, std::vector<char>> planes;
  Imf::FrameBuffer buffer;
  header.channels() = Imf::ChannelList();
  for (const std::string& name : names) {
    const Imf::Channel* channel = input.header().channels().findChannel(name);
    if (!channel) throw std::runtime_error(from + " has no channel " + name);
    const std::size_t bytes = channel->type == Imf::HALF ? 2 : 4;
    planes[name].resize(pixels * bytes);
    buffer.insert(name, Imf::Slice::Make(channel->type, planes[name].data(), window, bytes, bytes * width));
    header.channels().insert(name, *channel);
  }
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);

  for (auto& [name, plane] : planes) {
    if (input.header().channels()[name].type != Imf::FLOAT) continue;
    auto* values = reinterpret_cast<float*>(plane.data());
    for (std::size_t i = 0; i < pixels; ++i)
      values[i] = is_depth(name) ? rounded_depth(values[i]) : rounded_vector(values[i]);
  }
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 9;
  Imf::OutputFile output(to.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(int(pixels / width));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 4) throw std::runtime_error("usage: varve_cut_sequence IN.exr OUT.exr CHANNEL...");
    cut(argv[1], argv[2], std::vector<std::string>(argv + 3, argv + argc));
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "varve_cut_sequence: %s\n", e.what());
    return 2;
  }
}
