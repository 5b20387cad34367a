// A score without truth: what the other frames say of a pixel against the sample that the present frame has there.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Sums over R, G, B of the pixels whose sample is finite. The noise of the sample is not known to the prediction, so
/// the expected square is the error of the prediction plus the noise, which is the same for every setting: the score
/// ranks settings, it does not tell how wrong they are. Where a setting has no history, the mean of the neighbors
/// stands in for it, so that every setting is judged by the same pixels and cannot gain by giving up on the hard ones.
struct LeaveOut {
  std::size_t values = 0, without_history = 0;  ///< counts of R, G, B values
  double linear = 0;                            ///< squares of differences after holding to 0..1
  double tone = 0;                              ///< squares after x / (1 + x), negative values counting as 0

  LeaveOut& operator+=(const LeaveOut& more);
  double psnr() const;       ///< dB, peak 1; NaN without values
  double psnr_tone() const;  ///< likewise
};

/// All planes over the same window. `sample`: the frame as it was rendered, 0 where `bad`. `prediction`: the color that
/// all other frames give. `reject`: RejectBit sums; pixels without history have another bit than kRejectPresent, and
/// those at the start of a shot take no part, because there no setting has history.
LeaveOut leave_out_error(const Plane<glm::vec4>& sample, const Plane<std::uint8_t>& bad,
                         const Plane<glm::vec4>& prediction, const Plane<std::uint32_t>& reject, Workers& workers);

}  // namespace varve
