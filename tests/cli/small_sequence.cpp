#include "small_sequence.h"

#include <Imath/half.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <array>
#include <cstdio>
#include <exception>
#include <vector>

namespace varve::test {
namespace {

/// Sets of 16 jitters would do as well; any fixed numbers inside the pixel serve.
std::string note_of(int frame) {
  std::array<char, 128> text;
  std::snprintf(text.data(), text.size(), R"({"frame":%d,"jitter":[%.4f,%.4f],"spp":1})", frame,
                0.25 * ((frame * 3) % 4) - 0.375, 0.25 * ((frame * 5) % 4) - 0.375);
  return text.data();
}

/// Channel data of one type, row after row.
template <class T>
struct Rows {
  int width;
  std::vector<T> values;
  Rows(int w, int h, T value) : width(w), values(std::size_t(w) * std::size_t(h), value) {}
  T& at(int x, int y) { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
  Imf::Slice slice(Imf::PixelType type) {
    return Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(T), sizeof(T) * std::size_t(width));
  }
};

}  // namespace

void write_small_frame(const std::filesystem::path& path, int frame, const SmallSequence& sequence) {
  const int w = sequence.width, h = sequence.height;
  Rows<half> r(w, h, half(0.25f)), g(w, h, half(0.5f)), b(w, h, half(0.75f)), a(w, h, half(1.0f));
  Rows<float> z(w, h, 10.0f), vx(w, h, 0.0f), vy(w, h, 0.0f), vz(w, h, 0.0f), vw(w, h, 0.0f);
  Rows<unsigned> id(w, h, 1);
  for (int y = h / 4; y < h / 2; ++y)
    for (int x = w / 4 + frame; x < w / 2 + frame && x < w; ++x) {
      r.at(x, y) = half(4.0f);
      z.at(x, y) = 5.0f;
      vx.at(x, y) = vz.at(x, y) = -1.0f;  // X: previous minus current; Z: current minus next
      id.at(x, y) = 4000000000u;
    }

  Imf::Header header(w, h);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("Note", Imf::StringAttribute(note_of(frame)));
  header.insert("owner", Imf::StringAttribute("a custom attribute"));
  Imf::FrameBuffer pixels;
  const auto add = [&](const std::string& name, Imf::PixelType type, auto& rows) {
    header.channels().insert(name, Imf::Channel(type));
    pixels.insert(name, rows.slice(type));
  };
  add("ViewLayer.Combined.R", Imf::HALF, r);
  add("ViewLayer.Combined.G", Imf::HALF, g);
  add("ViewLayer.Combined.B", Imf::HALF, b);
  add("ViewLayer.Combined.A", Imf::HALF, a);
  if (sequence.with_depth) add("ViewLayer.Depth.Z", Imf::FLOAT, z);
  if (sequence.with_vectors) {
    add("ViewLayer.Vector.X", Imf::FLOAT, vx);
    add("ViewLayer.Vector.Y", Imf::FLOAT, vy);
    add("ViewLayer.Vector.Z", Imf::FLOAT, vz);
    add("ViewLayer.Vector.W", Imf::FLOAT, vw);
  }
  if (sequence.with_ids) add("ViewLayer.IndexOB.X", Imf::UINT, id);
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(pixels);
  file.writePixels(h);
}

void write_small_sequence(const std::filesystem::path& folder, const SmallSequence& sequence) {
  for (int frame = 1; frame <= sequence.frames; ++frame) {
    std::array<char, 32> name;
    std::snprintf(name.data(), name.size(), "in.%04d.exr", frame);
    write_small_frame(folder / name.data(), frame, sequence);
  }
}

ChannelValues channel_of(const std::filesystem::path& path, const std::string& channel) {
  Imf::InputFile file(path.c_str(), 0);
  const Imath::Box2i window = file.header().dataWindow();
  const int w = window.max.x - window.min.x + 1, h = window.max.y - window.min.y + 1;
  ChannelValues read{window.min.x, window.min.y, w, h, {}};
  read.values.assign(std::size_t(w) * std::size_t(h), -12345.0f);
  Imf::FrameBuffer pixels;
  pixels.insert(channel, Imf::Slice::Make(Imf::FLOAT, read.values.data(), window));
  file.setFrameBuffer(pixels);
  file.readPixels(window.min.y, window.max.y);
  return read;
}

float pixel_of(const std::filesystem::path& path, const std::string& channel, int x, int y) {
  return channel_of(path, channel).at(x, y);
}

bool is_complete(const std::filesystem::path& path) {
  try {
    Imf::InputFile file(path.c_str(), 0);
    if (!file.isComplete()) return false;
    pixel_of(path, file.header().channels().begin().name(), file.header().dataWindow().min.x,
             file.header().dataWindow().min.y);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace varve::test
