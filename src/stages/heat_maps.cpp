#include "stages/heat_maps.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <vector>

#include "diagnose/hdr_flip.h"
#include "exr/pictures.h"
#include "exr/write_frame.h"

namespace varve {
namespace {

bool within_unit_range(const Plane<glm::vec4>& color) {
  const Window& w = color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::vec4& c = color.at(x, y);
      if (!(std::max({c.r, c.g, c.b}) <= 1)) return false;
    }
  return true;
}

/// Over the part's data window; 0 where nothing was compared.
template <class Value>
RawPlane float_channel(const Window& window, const Window& inside, const Value& value) {
  RawPlane plane = make_raw_plane(PixelType::float32, window);
  std::vector<float> row(std::size_t(window.width()));
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x)
      row[std::size_t(x - window.x0)] = inside.contains(x, y) ? value(x, y) : 0.f;
    std::memcpy(plane.row(y - window.y0), row.data(), row.size() * sizeof(float));
  }
  return plane;
}

std::string file_base(const CompareJob& job, const FramePair& pair, const SubjectPair& subject) {
  std::array<char, 32> number;
  std::snprintf(number.data(), number.size(), pair.a.frame < 0 ? "heat.%05d" : "heat.%04d", pair.a.frame);
  std::string prefix;
  if (pair.match.subjects.size() > 1) {
    prefix = subject.name + ".";
    std::ranges::replace_if(
        prefix, [](char c) { return c == '/' || c == '\\' || c == ' '; }, '_');
  }
  return job.heat_folder + "/" + prefix + number.data();
}

}  // namespace

Plane<float> heat_map(const ColorPair& pair, Workers& workers) {
  if (within_unit_range(pair.a) && within_unit_range(pair.b)) return flip_map(pair.a, pair.b, pair.bad, workers);
  return hdr_flip_map(pair.a, pair.b, pair.bad, exposure_range(pair.a), workers);
}

void write_heat_maps(const CompareJob& job, const FramePair& pair, const SubjectPair& subject, const ColorPair& colors,
                     Workers& workers) {
  const FileHeader& source = pair.a.files.front();
  const int part = part_of(pair.a.subjects[subject.a]);
  const Window window = source.parts[std::size_t(part)].data_window, inside = colors.window();
  const Plane<float> heat = heat_map(colors, workers);
  std::array<RawPlane, 4> planes;
  for (int c = 0; c < 3; ++c)
    planes[std::size_t(c)] =
        float_channel(window, inside, [&](int x, int y) { return colors.b.at(x, y)[c] - colors.a.at(x, y)[c]; });
  planes[3] = float_channel(window, inside, [&](int x, int y) { return heat.at(x, y); });
  OutputPart output;
  output.source_part = part;
  output.compression = Compression::zip;
  constexpr std::array<const char*, 4> names = {"difference.R", "difference.G", "difference.B", "heat"};
  for (std::size_t k = 0; k < names.size(); ++k)
    output.channels.push_back({{names[k], PixelType::float32, 1, 1, false}, &planes[k]});
  const std::string base = file_base(job, pair, subject);
  write_map_png(base + ".png", heat, "magma", 0, 1);
  write_frame(base + ".exr", source, std::vector<OutputPart>{output}, {}, workers);
}

}  // namespace varve
