#include "deep/deep_sample.h"

#include <cmath>
#include <compare>
#include <limits>

namespace varve {

DeepDefects& DeepDefects::operator+=(const DeepDefects& other) {
  dropped += other.dropped;
  turned += other.turned;
  opacity += other.opacity;
  return *this;
}

bool repair(DeepSample& sample, DeepDefects& defects) {
  if (std::isnan(sample.front)) {
    ++defects.dropped;
    return false;
  }
  // A back that was never written is 0: exchanging the two would fill the way to the camera with fog.
  const bool volume = sample.back > sample.front && std::isfinite(sample.back) && std::isfinite(sample.front);
  if (!volume) {
    defects.turned += sample.back != sample.front;
    sample.back = sample.front;
  }
  bool held = false;
  for (int k = 0; k < 4; ++k) {
    double& a = sample.opacity[k];
    if (std::isnan(a)) {
      sample.color = glm::dvec4(std::numeric_limits<double>::quiet_NaN());
      a = 0;
      held = true;
    } else if (!(a >= 0 && a <= 1)) {
      a = a < 0 ? 0 : 1;
      held = true;
    }
  }
  defects.opacity += held;
  return true;
}

bool is_before(const DeepSample& a, const DeepSample& b) {
  if (a.front != b.front) return a.front < b.front;
  if (a.back != b.back) return a.back < b.back;
  if (a.back == a.front) return a.index < b.index;
  for (int k = 0; k < 4; ++k)
    if (a.opacity[k] != b.opacity[k]) return a.opacity[k] < b.opacity[k];
  for (int k = 0; k < 4; ++k)
    if (const auto order = std::strong_order(a.color[k], b.color[k]); order != 0) return order < 0;
  return a.index < b.index;
}

}  // namespace varve
