// How the color's history was fetched and moved at one pixel, in numbers that can be applied to any other channel.
//
// Clipping is not linear, but what it did at one pixel can be written as one: history went a part of the way towards
// the present and the mean of its neighbors, channel by channel. The parts are found from the color before and after,
// whatever box and rule moved it, and applied to the companion's own history, present and mean: history' = history +
// toward * (present + of_mean * (mean - present) - history). Coefficients depend on the color only, so the result is
// linear in the light, and channels that add up to the color still do. What two directions cannot explain is shared in
// proportion to what each channel has.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "resolve/accumulate_row.h"

namespace varve {

/// One plane of a frame and its history as the row pass sees it. Coordinates as in AccumulateView.
struct CompanionRows {
  PixelRows<const float> neighbors;  ///< samples, with a border as wide as the view's radius, 3 at most
  PixelRows<const float> present;    ///< what is blended in
  PixelRows<const float> history;    ///< null when there is none
  bool color = true;                 ///< places are R G B A; else each channel goes by the mean of R, G and B
};

/// Pixels of the history that a value is made from, and their weights.
struct CompanionTaps {
  bool found = false;        ///< false: the present stands in
  bool wide = false;         ///< sixteen pixels; else the inner four only
  int x = 0, y = 0;          ///< the pixel at or below the position
  double weight[4][4] = {};  ///< rows y-1..y+2, columns x-1..x+2; sum 1
  double inner[2][2] = {};   ///< the mean of the four nearest, which holds ringing
  bool holds_wide = false;   ///< held between all pixels that count positively, not the nearest four
  bool holds = false;        ///< hold is not 0
  glm::dvec3 hold{0.0};      ///< part of the way from the wide filter's value to the inner mean, against ringing
  int nearest_x = 0, nearest_y = 0;  ///< what differences are taken to, so that a constant stays that constant
};

/// Channel 3 is alpha. In YCoCg the first three are Y, Co and Cg.
struct CompanionMove {
  CompanionTaps taps;
  bool moved = false;  ///< the two below are not all 0
  bool needs_mean = false;
  glm::dvec4 toward{0.0};   ///< part of the way from history to its target
  glm::dvec4 of_mean{0.0};  ///< where between present (0) and mean (1) the target lies
  glm::dvec4 value{0.0};    ///< what became of the color's history
  glm::dvec4 rest{0.0};     ///< what is left, relative to the value
};

/// Finds what was done to the color at a pixel. `result` (four floats) is its history after rectification; where there
/// is no history, what became of the present. `standing`: see standing_taps().
CompanionMove find_move(const AccumulateView& view, const CompanionRows& color, int x, int y, bool has_history,
                        const float* result, unsigned standing);

/// The same done to another plane.
glm::dvec4 apply_move(const AccumulateView& view, const CompanionMove& move, const CompanionRows& plane, int x, int y);

/// One pixel of a plane.
inline glm::dvec4 pixel_of(PixelRows<const float> rows, int x, int y) {
  const float* p = rows.origin + y * rows.stride + 4 * x;
  return {p[0], p[1], p[2], p[3]};
}

}  // namespace varve
