// What the four histories say of a place in a pixel of the present.
#pragma once

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "resolve/accumulate.h"
#include "subpixel/subpixel_history.h"
#include "subpixel/tent_weights.h"

namespace varve {

/// A place, and the samples that say something of it.
struct Reconstruction {
  TentSamples samples;
  struct Texel {
    int x, y;
    std::size_t quadrant;
  };
  std::array<Texel, kMostTentSamples> texel;
  int heaviest = 0;     ///< sample of the largest weight
  bool found = false;   ///< there is enough of history to be believed
  unsigned reject = 0;  ///< why not, or what speaks against some of it
};

/// The samples around the middle of quarter `target` of pixel (x, y). Each history is sought where its way leads; each
/// sample is tested by itself: inside the window, valid, and of the same surface as far as `recursive` asks for.
Reconstruction reconstruct(const SubpixelHistory& history, const Present& present, const SubpixelParameters& subpixel,
                           const RecursiveParameters& recursive, std::size_t target, int x, int y);

/// The color, or a companion, that the samples give; `plane(buffer)` is the plane to read. One color gives that color.
template <class PlaneOf>
glm::dvec4 weighed_color(const SubpixelHistory& history, const Reconstruction& r, PlaneOf plane) {
  const auto at = [&](int i) {
    const auto& t = r.texel[std::size_t(i)];
    return glm::dvec4(plane(history.quadrants[t.quadrant]).at(t.x, t.y));
  };
  const glm::dvec4 pivot = at(r.heaviest);
  glm::dvec4 sum(0.0);
  for (int i = 0; i < r.samples.count; ++i)
    if (r.samples.weight[std::size_t(i)] != 0) sum += (at(i) - pivot) * r.samples.weight[std::size_t(i)];
  return pivot + sum;
}

/// What else the samples give: total and spread are means under the tent; the moments are those of the kernel around
/// the place.
struct ReconstructedWeights {
  double total = 0, spread = 0;
  glm::dvec3 moments{0.0};
  double carried = 0;  ///< px^2: what of the second moment is of this reading, and not of the histories before
};
ReconstructedWeights weighed_history(const SubpixelHistory& history, const Reconstruction& r);

}  // namespace varve
