#include "samples/add_samples.h"

#include "samples/resolve_samples.h"
#include "samples/weigh_positions.h"

namespace varve {
namespace {

Plane<float> count_samples(Samples samples, Workers& workers) {
  const Window& w = samples.front()->color.window();
  Plane<float> count(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      float n = 0;
      for (const Present* sample : samples) n += sample->valid.at(x, y);
      count.at(x, y) = n;
    }
  });
  return count;
}

}  // namespace

Present add_samples(Present first, const std::vector<Present>& further, SampleFilter filter, Workers& workers) {
  if (further.empty()) return first;
  std::vector<const Present*> all = {&first};
  for (const Present& present : further) all.push_back(&present);
  Present out = resolve_samples(all, SampleFilter::none, workers);
  out.not_finite = 0;
  for (const Present* sample : all) out.not_finite += sample->not_finite;
  out.jitter = first.jitter;
  out.transmittance = std::move(first.transmittance);
  out.combined = std::move(first.combined);
  if (filter == SampleFilter::none) {
    out.sample_weight = count_samples(all, workers);
    return out;
  }
  Present weighed;
  weigh_positions(all, filter, weighed, workers, 1);
  out.reconstructed = std::move(weighed.color);
  out.sample_weight = std::move(weighed.sample_weight);
  return out;
}

}  // namespace varve
