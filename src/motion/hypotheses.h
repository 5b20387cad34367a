// What stored vectors might mean: every hypothesis, where it says that a place came from, and how it fits the pixels.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/window.h"
#include "motion/convention.h"

namespace varve {

/// Channels of one layer that are looked at together.
inline constexpr std::size_t kGroupChannels = 4;
using StoredValues = std::array<float, kGroupChannels>;

/// A place whose motion was measured from the pixels, with what is stored for it.
struct FollowedPlace {
  int pair = 0;                  ///< of frames, counted from 0
  glm::dvec2 at{0};              ///< pixel
  glm::dvec2 moved{0};           ///< position in the earlier frame minus the one here, px, y down,
                                 ///< jitter taken out
  glm::dvec2 jitter{0};          ///< of this frame minus of the earlier one, px
  double difference = 0;         ///< of the patches, see patch_difference
  double pixel = 1;              ///< px, edge of the pixels it was measured with: motion is known to fractions of these
  StoredValues here{}, there{};  ///< stored in this frame here, and in the earlier one where the
                                 ///< place was; NaN where there is none or it varies
};

/// One reading of two channels. Without `scale_free` the encoding's scale is part of the hypothesis; with it the pixels
/// decide.
struct VectorHypothesis {
  int x = 0, y = 1;  ///< channels of the group
  MotionEncoding encoding;
  int jitter = 0;  ///< 1: the change of jitter is in the vectors; -1: the other way round
  bool scale_free = false;
};

/// Everything that is tested for a pair of channels: order, signs, units, bias, direction; the scale open or as the
/// units say. `square` pictures do not tell axes of different length apart.
std::vector<VectorHypothesis> vector_hypotheses(int first, int second, bool square);

/// Where the place came from by a hypothesis: as FollowedPlace::moved. NaN where nothing is stored.
glm::dvec2 predicted(const VectorHypothesis& hypothesis, const FollowedPlace& place, const Window& display);

/// Distance of prediction and measurement that still counts as agreement: half a pixel (of the level it was measured
/// on) and 2 % of the way.
double tolerance_of(const FollowedPlace& place);

/// Whether both channels hold what they hold at rest: such vectors say nothing, or that there are none.
bool is_at_rest(const VectorHypothesis& hypothesis, const FollowedPlace& place);

/// How a hypothesis does on all places. What moves is what is measured or predicted to move by more than a pixel;
/// aliased detail at rest is sometimes found elsewhere, so agreement is counted where the hypothesis itself sees
/// motion.
struct Fit {
  double score = 0;            ///< 0..1, mean closeness over what moves (3/4) and what rests (1/4)
  double agreement = 0;        ///< share of what is predicted to move that agrees, see tolerance_of
  double rough_agreement = 0;  ///< the same within half a pixel and a quarter of the way
  double recall = 0;           ///< share of what is measured to move that agrees
  double off = 0;              ///< px, median distance of what is predicted to move
  std::size_t predicted = 0;   ///< places predicted to move
  std::size_t moving = 0;      ///< places measured to move that have a vector
};
Fit fit_of(const VectorHypothesis& hypothesis, const std::vector<FollowedPlace>& places, const Window& display);
/// The same for no motion at all.
Fit fit_of_rest(const std::vector<FollowedPlace>& places);

/// The scale that fits best (written into the encoding's scale, as a factor on what it was), or 0 where none does. With
/// its standard deviation over the places that agree.
struct FoundScale {
  double scale = 0, deviation = 0;
  double scale_x = 0, scale_y = 0;  ///< each axis by itself; 0 where too little moves along it
};
FoundScale find_scale(VectorHypothesis& hypothesis, const std::vector<FollowedPlace>& places, const Window& display);

/// "to the previous frame, pixels, x right, y up".
std::string words_of(const VectorHypothesis& hypothesis);

}  // namespace varve
