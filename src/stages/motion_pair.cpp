#include "stages/motion_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "exr/convert.h"
#include "stages/flatten_deep.h"

namespace varve {
namespace {

Plane<float> plane_of(const RawPlane& raw, Workers& workers) {
  Plane<float> plane(raw.window);
  workers.for_rows(raw.window.y0, raw.window.y1, [&](int y) {
    to_float(raw.type, raw.row(y - raw.window.y0), plane.row(y), std::size_t(raw.window.width()));
  });
  return plane;
}

FileSet read_refs(const FrameHeaders& headers, const std::vector<ChannelRef>& refs, Workers& workers) {
  FileSet files;
  DeepFrame untold;
  for (int file = 0; file < int(headers.files.size()); ++file) {
    std::vector<ChannelRef> here;
    for (const ChannelRef& ref : refs)
      if (ref.file == file && std::find(here.begin(), here.end(), ref) == here.end()) here.push_back(ref);
    files.push_back(here.empty() ? FramePixels{} : read_flat(headers, file, here, here, {}, untold, workers));
  }
  return files;
}

}  // namespace

FrameVectors read_frame_vectors(const FrameHeaders& headers, std::size_t k, const MotionParameters& motion,
                                const VectorNeeds& needs, Workers& workers) {
  Subject subject = headers.subjects[k];
  subject.companions.clear();
  FrameVectors frame;
  if (needs.vectors) frame.layers = vector_layers(headers.files, subject);
  if (needs.only) frame.layers.push_back({"", true, {(*needs.only)[0], (*needs.only)[1]}, {}});
  std::vector<ChannelRef> refs;
  for (const std::optional<ChannelRef>& channel : subject.color)
    if (channel) refs.push_back(*channel);
  if (needs.marks && subject.depth) refs.push_back(*subject.depth);
  if (needs.marks && subject.id) refs.push_back(*subject.id);
  for (const VectorLayer& layer : frame.layers) refs.insert(refs.end(), layer.channels.begin(), layer.channels.end());
  const FileSet files = read_refs(headers, refs, workers);

  const Part& part = headers.files.front().parts[std::size_t(part_of(subject))];
  frame.display = part.display_window;
  ReadOptions options;
  options.motion = motion;
  options.use_depth = options.use_id = needs.marks;
  std::size_t none = 0;
  frame.present = read_present(subject, files, part.data_window, part.display_window, options, nullptr, none, workers);
  for (const VectorLayer& layer : frame.layers) {
    std::vector<Plane<float>>& planes = frame.values.emplace_back();
    for (const ChannelRef& ref : layer.channels) planes.push_back(plane_of(files[std::size_t(ref.file)][ref], workers));
  }
  return frame;
}

StoredValues values_at(const std::vector<Plane<float>>& channels, const std::vector<double>& ranges, int x, int y,
                       int radius) {
  StoredValues values;
  values.fill(std::numeric_limits<float>::quiet_NaN());
  const int step = std::max(1, radius / 5);
  for (std::size_t c = 0; c < channels.size() && c < values.size(); ++c) {
    const Window& w = channels[c].window();
    if (!w.contains(x, y)) continue;
    const double middle = double(channels[c].at(x, y));
    bool even = std::isfinite(middle);
    for (int py = std::max(y - radius, w.y0); even && py <= std::min(y + radius, w.y1 - 1); py += step)
      for (int px = std::max(x - radius, w.x0); px <= std::min(x + radius, w.x1 - 1); px += step)
        even = even && std::abs(double(channels[c].at(px, py)) - middle) <= 0.1 * ranges[c];
    if (even) values[c] = channels[c].at(x, y);
  }
  return values;
}

StoredValues values_between(const std::vector<Plane<float>>& channels, const std::vector<double>& ranges,
                            const glm::dvec2& at, int radius) {
  StoredValues values = values_at(channels, ranges, int(std::lround(at.x)), int(std::lround(at.y)), radius);
  const int x = int(std::floor(at.x)), y = int(std::floor(at.y));
  const double fx = at.x - x, fy = at.y - y;
  for (std::size_t c = 0; c < channels.size() && c < values.size(); ++c) {
    const Plane<float>& plane = channels[c];
    if (std::isnan(values[c]) || !plane.window().contains(x, y) || !plane.window().contains(x + 1, y + 1)) continue;
    const auto v = [&](int dx, int dy) { return double(plane.at(x + dx, y + dy)); };
    const double top = v(0, 0) * (1 - fx) + v(1, 0) * fx, low = v(0, 1) * (1 - fx) + v(1, 1) * fx;
    values[c] = float(top * (1 - fy) + low * fy);
  }
  return values;
}

std::vector<double> ranges_of(const std::vector<Plane<float>>& channels) {
  std::vector<double> ranges;
  for (const Plane<float>& plane : channels) {
    const Window& w = plane.window();
    const int step = std::max(1, int(std::sqrt(double(w.pixels()) / 10000)));
    std::vector<float> values;
    for (int y = w.y0; y < w.y1; y += step)
      for (int x = w.x0; x < w.x1; x += step)
        if (std::isfinite(plane.at(x, y))) values.push_back(plane.at(x, y));
    std::sort(values.begin(), values.end());
    const std::size_t tail = values.size() / 1000;
    ranges.push_back(values.empty() ? 0 : double(values[values.size() - 1 - tail]) - double(values[tail]));
  }
  return ranges;
}

std::vector<std::pair<int, int>> frame_pairs(const std::vector<int>& frames, int count) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 1; i < frames.size(); ++i) least = std::min(least, std::int64_t(frames[i]) - frames[i - 1]);
  std::vector<std::pair<int, int>> all;
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (std::int64_t(frames[i]) - frames[i - 1] == least) all.push_back({frames[i - 1], frames[i]});
  const std::size_t n = std::min(all.size(), std::size_t(std::max(count, 0)));
  std::vector<std::pair<int, int>> chosen;
  // From the middle of equal parts: first and last frames of a shot are often at rest.
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(all[(2 * i + 1) * all.size() / (2 * n)]);
  return chosen;
}

}  // namespace varve
