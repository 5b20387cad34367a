#include "support/frame_file.h"

#include <ImathVec.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <half.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace varve::test {
namespace {

Imath::Box2i box_of(const Window& w) { return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}}; }

/// The library adds x * step and y * stride to a base that may lie outside the plane.
template <class T>
Imf::Slice slice_of(Plane<T>& plane, Imf::PixelType type) {
  const Window& w = plane.window();
  char* const first = reinterpret_cast<char*>(plane.row(w.y0));
  const std::ptrdiff_t row = plane.stride() * std::ptrdiff_t(sizeof(T));
  char* const base = first - std::ptrdiff_t(w.x0) * std::ptrdiff_t(sizeof(T)) - std::ptrdiff_t(w.y0) * row;
  return Imf::Slice(type, base, sizeof(T), std::size_t(row));
}

Plane<half> as_half(const Plane<float>& plane) {
  const Window& w = plane.window();
  Plane<half> to(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) to.at(x, y) = half(plane.at(x, y));
  return to;
}

}  // namespace

void write_frame_file(const std::filesystem::path& path, const FrameFile& frame) {
  Imf::Header header(box_of(frame.display), box_of(frame.data));
  header.compression() = Imf::NO_COMPRESSION;
  header.insert("varve:motion", Imf::StringAttribute("varve"));
  if (frame.jitter)
    header.insert("jitter", Imf::V2fAttribute(Imath::V2f(float(frame.jitter->x), float(frame.jitter->y))));
  Imf::FrameBuffer pixels;
  std::vector<Plane<half>> halves;
  halves.reserve(frame.half.size());
  for (const auto& [name, plane] : frame.channels) {
    const bool narrow = frame.half.contains(name);
    header.channels().insert(name, Imf::Channel(narrow ? Imf::HALF : Imf::FLOAT));
    if (narrow)
      pixels.insert(name, slice_of(halves.emplace_back(as_half(plane)), Imf::HALF));
    else  // the library takes pointers to what it will only read
      pixels.insert(name, slice_of(const_cast<Plane<float>&>(plane), Imf::FLOAT));
  }
  for (const auto& [name, plane] : frame.ids) {
    header.channels().insert(name, Imf::Channel(Imf::UINT));
    pixels.insert(name, slice_of(const_cast<Plane<std::uint32_t>&>(plane), Imf::UINT));
  }
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(pixels);
  file.writePixels(frame.data.height());
}

ReadFile read_frame_file(const std::filesystem::path& path) {
  Imf::InputFile file(path.c_str(), 0);
  const Imath::Box2i box = file.header().dataWindow();
  ReadFile read;
  read.data = {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
  Imf::FrameBuffer pixels;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    Plane<float>& plane = read.channels[c.name()] = Plane<float>(read.data);
    pixels.insert(c.name(), slice_of(plane, Imf::FLOAT));
  }
  file.setFrameBuffer(pixels);
  file.readPixels(box.min.y, box.max.y);
  return read;
}

FrameFile frame_of(const World& world, int frame, const FileOptions& o) {
  FrameFile file;
  file.data = o.data;
  file.display = o.display.value_or(o.data);
  const int turn = ((frame - 1) % o.jitter_period + o.jitter_period) % o.jitter_period + 1;
  glm::dvec2 jitter(0);
  if (o.jitter) jitter = {double(float(halton(turn, 2) - 0.5)), double(float(halton(turn, 3) - 0.5))};
  if (o.jitter) file.jitter = jitter;
  const auto add = [&](const char* name) -> Plane<float>& {
    return file.channels[name] = Plane<float>(o.data, 0, 0.0f);
  };
  std::array<Plane<float>*, 4> color{&add("R"), &add("G"), &add("B"), &add("A")};
  if (o.half) file.half = {"R", "G", "B", "A"};
  Plane<float>* depth = o.depth ? &add("Z") : nullptr;
  Plane<float>*back_x = nullptr, *back_y = nullptr, *on_x = nullptr, *on_y = nullptr;
  if (o.vectors) back_x = &add("velocity.x"), back_y = &add("velocity.y");
  if (o.vectors && o.forward) on_x = &add("forward.x"), on_y = &add("forward.y");
  if (o.ids) file.ids["id"] = Plane<std::uint32_t>(o.data);
  for (int y = o.data.y0; y < o.data.y1; ++y)
    for (int x = o.data.x0; x < o.data.x1; ++x) {
      const Seen seen = world(glm::dvec2(x + 0.5, y + 0.5) + jitter, frame);
      for (int k = 0; k < 4; ++k) color[std::size_t(k)]->at(x, y) = seen.color[k];
      if (depth) depth->at(x, y) = seen.depth;
      if (back_x) back_x->at(x, y) = float(seen.back.x), back_y->at(x, y) = float(seen.back.y);
      if (on_x) on_x->at(x, y) = float(seen.on.x), on_y->at(x, y) = float(seen.on.y);
      if (o.ids) file.ids["id"].at(x, y) = seen.id;
    }
  return file;
}

std::string frame_number(int frame) {
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "%04d", frame);
  return text.data();
}

void write_shot(const std::filesystem::path& folder, const World& world, int first, int last,
                const FileOptions& options) {
  std::filesystem::create_directories(folder);
  for (int frame = first; frame <= last; ++frame)
    write_frame_file(folder / ("in." + frame_number(frame) + ".exr"), frame_of(world, frame, options));
}

double chance(std::uint32_t x, std::uint32_t y, std::uint32_t frame, std::uint32_t salt) {
  std::uint32_t h = x * 73856093u ^ y * 19349663u ^ frame * 83492791u ^ salt * 2654435761u;
  h = (h ^ (h >> 16)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  h ^= h >> 16;
  return double(h) / 4294967296.0;
}

}  // namespace varve::test
