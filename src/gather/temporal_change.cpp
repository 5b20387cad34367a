#include "gather/temporal_change.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace varve {
namespace {

constexpr std::size_t kRings = 10;  // up to 512 frames away

/// Ring of a frame: 0 for the neighbors and the frame itself, then by octaves; odd for the past, even for the future.
std::size_t ring_of(std::size_t frame, std::size_t present) {
  const bool past = frame < present;
  const std::size_t distance = past ? present - frame : frame - present;
  if (distance < 2) return 0;
  return std::min(std::size_t(std::bit_width(distance)) - 1, kRings - 1) * 2 - (past ? 1 : 0);
}

/// Centred sums of one ring.
struct Ring {
  double sum = 0, squares = 0, count = 0;
  double mean() const { return sum / count; }
  double variance() const { return std::max(squares / count - mean() * mean(), 0.0); }
};

}  // namespace

void turn_down_changed(std::span<const Arrival* const> arrivals, std::size_t present, std::size_t samples, double limit,
                       float* weights) {
  if (!(limit > 0)) return;
  std::array<Ring, 2 * kRings> rings{};
  const double shift = double(arrivals.front()->light);
  for (const Arrival* a : arrivals) {
    Ring& r = rings[ring_of(frame_of(*a, samples), present)];
    const double light = double(a->light) - shift;
    r.sum += light;
    r.squares += light * light;
    r.count += 1;
  }
  const Ring& near = rings[0];
  if (near.count < 3) return;
  std::array<float, 2 * kRings> turned;
  turned.fill(1);
  for (std::size_t k = 1; k < rings.size(); ++k) {
    const Ring& r = rings[k];
    if (r.count < 2) continue;
    const double variance = std::max(near.variance(), r.variance());
    const double difference = r.mean() - near.mean();
    const double squared = difference * difference, error = variance * (1 / near.count + 1 / r.count);
    if (!(squared > limit * limit * error)) continue;
    // Beyond the limit by one standard error: half.
    const double beyond = error > 0 ? std::sqrt(squared / error) - limit : 1e6;
    turned[k] = float(1 / (1 + std::min(beyond * beyond, 1e6)));
  }
  for (std::size_t i = 0; i < arrivals.size(); ++i)
    weights[i] *= turned[ring_of(frame_of(*arrivals[i], samples), present)];
}

}  // namespace varve
