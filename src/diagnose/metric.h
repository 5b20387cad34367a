// The table of metrics, and what a limit on one means.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace varve {

enum class MetricId {
  missing,
  not_finite,
  differing,
  max,
  mean,
  rmse,
  relmse,
  psnr,
  psnr_tone,
  psnr_pu,
  ssim,
  flip,
  hdr_flip,
  bias,
  flicker,
  warped,
  spectrum,
  tflip,
  ghost,
  sharpness,
  lag,
  half_life,
  mtf50,
  edge_width,
  edge_blur,
};
inline constexpr std::size_t kMetricCount = std::size_t(MetricId::edge_blur) + 1;

enum class Better { down, up };
/// What a figure belongs to: each frame; a frame and the one before it; the whole sequence.
enum class MetricScope { frame, pair, sequence };

struct Metric {
  MetricId id;
  std::string_view name, unit;
  Better better;
  MetricScope scope;
  bool slow;  ///< not in the set `fast`
  std::string_view meaning;
};

/// In the order of reports.
std::span<const Metric> metrics();
const Metric& metric_of(MetricId id);
/// None (null) for an unknown name.
const Metric* find_metric(std::string_view name);

using MetricSet = std::bitset<kMetricCount>;

/// One figure for each metric; NaN where it was not or cannot be measured.
struct MetricValues {
  std::array<double, kMetricCount> values;
  MetricValues() { values.fill(std::numeric_limits<double>::quiet_NaN()); }
  double& operator[](MetricId id) { return values[std::size_t(id)]; }
  double operator[](MetricId id) const { return values[std::size_t(id)]; }
};

/// A figure that a value must reach (better up) or not exceed (better down).
struct Limit {
  MetricId metric;
  double value = 0;
  bool fail = true;  ///< false: only a warning
};

/// False for NaN: what could not be measured does not hold a limit.
bool holds(const Limit& limit, double value);

/// The answer of a comparison.
enum class Verdict {
  equal,         ///< every compared value is the same
  within,        ///< differences, all within the limits
  beyond,        ///< differences beyond a limit, or any where no limit is given
  incomparable,  ///< windows, channels or frames that do not fit together
};
const char* name_of(Verdict verdict);

}  // namespace varve
