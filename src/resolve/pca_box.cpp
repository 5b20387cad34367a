#include "resolve/pca_box.h"

#include <algorithm>

#include <glm/common.hpp>

namespace varve {

PcaBox make_pca_box(const Samples& samples, const Moments& moments, double floor) {
  PcaBox box{principal_axes(samples, moments), glm::dvec3(0), glm::dvec3(0)};  // the mean is inside
  for (const glm::dvec4& c : samples) {
    const glm::dvec3 along = box.frame.to_axes(glm::dvec3(c));
    box.low = glm::min(box.low, along);
    box.high = glm::max(box.high, along);
  }
  box.low -= floor;
  box.high += floor;
  return box;
}

double PcaBox::crossing(const glm::dvec3& g, const glm::dvec3& h) const {
  const glm::dvec3 from = frame.to_axes(g), to = frame.to_axes(h);
  double t = 1;
  for (int k = 0; k < 3; ++k) {
    const double bound = to[k] > high[k] ? high[k] : low[k];
    if (to[k] > high[k] || to[k] < low[k])
      t = from[k] == to[k] ? 0 : std::min(t, (bound - from[k]) / (to[k] - from[k]));
  }
  return std::max(t, 0.0);
}

glm::dvec3 PcaBox::nearest(const glm::dvec3& h) const {
  const glm::dvec3 along = frame.to_axes(h), held = glm::clamp(along, low, high);
  return held == along ? h : frame.from_axes(held);  // what is inside stays bit for bit
}

}  // namespace varve
