#include "stages/settle_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/median.h"
#include "plan/value.h"
#include "stages/read_present.h"
#include "stages/source_frame.h"

namespace varve {
namespace {

/// A layer with the median of its finite depths where it covers something; infinite where it covers nothing.
struct LayerDepth {
  std::string layer;
  double median = std::numeric_limits<double>::infinity();
};

double median_depth(const Present& layer) {
  const Window w = intersect(layer.color.window(), layer.depth.window());
  std::vector<float> depths;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (layer.color.at(x, y).w > 0 && std::isfinite(layer.depth.at(x, y))) depths.push_back(layer.depth.at(x, y));
  return double(upper_median(std::move(depths), std::numeric_limits<float>::infinity()));
}

std::vector<LayerDepth> measure_depths(const ResolveJob& job, int frame, Workers& workers) {
  const FrameHeaders headers = read_frame_headers(job.input, frame, job.roles, parse_jitter_source("none"));
  for (const Subject& subject : headers.subjects)
    if (!subject.depth)
      throw Failure(ExitCode::inconsistent, "--layer-order depth needs a depth of every layer, and layer " +
                                                subject.layer +
                                                " has none; list the layers front to back with "
                                                "--layer and give --layer-order list");
  DeepFrame deep;
  const FileSet pixels = in_frame(frame, [&] { return read_files(headers, {.depth = true}, deep, workers); });
  std::vector<LayerDepth> depths;
  for (const Subject& subject : headers.subjects) {
    const auto same = [&](const LayerDepth& d) { return d.layer == subject.layer; };
    if (std::any_of(depths.begin(), depths.end(), same)) continue;  // another view of it
    const Part& part = headers.files.front().parts[std::size_t(part_of(subject))];
    ReadOptions read{.motion = job.parameters.motion, .use_depth = true};
    std::size_t unused = 0;
    depths.push_back({subject.layer, median_depth(read_present(subject, pixels, part.data_window, part.display_window,
                                                               read, nullptr, unused, workers))});
  }
  std::stable_sort(depths.begin(), depths.end(),
                   [](const LayerDepth& a, const LayerDepth& b) { return a.median < b.median; });
  return depths;
}

bool is_asked_for(const std::vector<std::string>& aovs, const char* name) {
  return std::find(aovs.begin(), aovs.end(), name) != aovs.end();
}

}  // namespace

SettledLayers settle_layers(const ResolveJob& job) {
  SettledLayers ordered{job, ""};
  const LayersRequest& request = job.roles.combine_layers;
  ordered.job.roles.combine_layers.difference = is_asked_for(job.request.aovs, "layer-difference");
  if (request.mode == LayersMode::apart || request.order != LayerOrder::depth) return ordered;
  const std::vector<int> on_disk = job.input.color.frames_on_disk();
  if (on_disk.empty()) return ordered;  // what is missing is told by the probe
  Workers workers(job.threads);
  const std::vector<LayerDepth> depths = measure_depths(job, on_disk.front(), workers);
  ordered.job.roles.layers.clear();
  for (const LayerDepth& d : depths) {
    ordered.job.roles.layers.push_back(d.layer);
    ordered.note += (ordered.note.empty() ? "" : ", ") + d.layer + " " +
                    (std::isfinite(d.median) ? short_number(d.median) : std::string("covers nothing"));
  }
  ordered.note = "layers: ordered by the median depth of what they cover in frame " + std::to_string(on_disk.front()) +
                 ": " + ordered.note;
  return ordered;
}

}  // namespace varve
