// A score without truth: what the other frames say of a pixel against the sample that the present frame has there.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Sums over R, G, B. The resolved frame before is brought along the motion and held against the samples of the present
/// frame, which had no part in it, not even as neighbors: a jittered frame shifts all its samples alike, so a
/// prediction that has seen the neighbors would know part of the noise it is judged by. The expected square is then the
/// error of the resolved frame plus the noise of the sample and the change since, which are the same for every setting:
/// the score ranks settings, it does not tell how wrong they are. Which pixels count does not depend on the setting
/// either.
///
/// Differences stay linear, because the tone-mapped mean of noisy samples is not their mean tone-mapped; they are
/// weighted by the slope of x / (1 + x) at the mean of the neighboring samples instead, which no setting can influence.
/// Their means over 3x3 and 5x5 pixels are added, where less of the noise and all of a lost highlight is left.
struct LeaveOut {
  std::size_t values = 0;
  double squares = 0;

  LeaveOut& operator+=(const LeaveOut& more);
  double mean() const;      ///< NaN without values
  double decibels() const;  ///< -10 log10 of the mean
};

/// `sample`: the present frame as it was rendered, 0 where `bad`; `before`: the resolved frame before; `motion`:
/// backward vectors in pixels over the window of `sample`, empty for no motion. Pixels take part whose sample is good
/// and whose vector is finite and leads into `before`.
LeaveOut leave_out_error(const Plane<glm::vec4>& sample, const Plane<std::uint8_t>& bad, const Plane<glm::vec4>& before,
                         const Plane<glm::vec2>& motion, Workers& workers);

}  // namespace varve
