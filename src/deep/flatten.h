// A deep pixel made flat: composited front to back, and told which of its samples it follows.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec4.hpp>

#include "base/combine_request.h"
#include "deep/visibility.h"

namespace varve {

struct FlatPixel {
  glm::dvec4 color{0.0};   ///< premultiplied; alpha is the sum of the changes of transmittance
  std::size_t winner = 0;  ///< DeepSample::index
  std::size_t place = 0;   ///< of the winner, front to back; 0 and up
  double variation = 0;    ///< change of transmittance across the winner, 0..1; RGB by luminance
  std::size_t seen = 0;    ///< samples that change transmittance or add light
};

/// Room that is used again from pixel to pixel, and the visibilities of the pixel that was flattened last.
struct FlattenScratch {
  DeepLayout layout;
  VisibilityScratch visibility_scratch;
  std::vector<double> opacity;
  std::array<std::vector<double>, 4> visibility;  ///< of R, G, B and A, in the order of the sorted samples
};

/// Sorts the samples (repaired, at least one) and flattens them. `colored`: the opacities of R, G, B and A differ; if
/// not, that of A counts for all. The winner lends the pixel its motion, depth and id. It is a whole sample, whatever
/// pieces others cut it into; ties go to the
/// front. Hidden samples have no say, NaN colors included. What is behind the last sample is no rival: there is nothing
/// there that could move.
FlatPixel flatten(std::vector<DeepSample>& samples, bool colored, LayerRule rule, FlattenScratch& scratch);

}  // namespace varve
