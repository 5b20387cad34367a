// Which history is not believed, and how much the present counts: the settings of the row passes around the kernel.
#pragma once

#include "resolve/choices.h"

namespace varve {

/// Tests of history against what else is known of a surface. Each is off by default. Sources: Lopez (depth, stencil,
/// id, acceleration, what to do on a rejection), Wronski 2014 (vector lengths, after Sousa 2011).
struct RejectParameters {
  double depth_slope = 0;   ///< under Disocclusion::depth: allowed besides the tolerance, as a multiple of how much the
                            ///< depth of the present changes over a pixel (Falcor's SVGF allows 10); 0: nothing
  double normal_angle = 0;  ///< degrees between the normals from which on it is another surface; 0: no test
  IdTest id = IdTest::off;
  double speed = 0;             ///< px, difference of the lengths of the vectors; 0: no test
  double direction = 0;         ///< degrees between the vectors; 0: no test
  double acceleration_low = 0;  ///< px, length of the difference of the vectors where doubt begins
  double acceleration = 0;      ///< px, where history is dropped; 0: no test
  OnReject on_reject = OnReject::restart;
  double alpha = 0.5;  ///< weight of the present in a rejected pixel under OnReject::weight

  bool tests_vectors() const { return speed > 0 || direction > 0 || acceleration > 0; }
  bool operator==(const RejectParameters&) const = default;
};

/// What moves the weight of the present pixel by pixel. All off by default, the masks where none is mapped.
struct WeightParameters {
  Feedback feedback = Feedback::fixed;
  double feedback_low = 0.88, feedback_high = 0.97;  ///< weight of history (Pedersen 2016)
  double speed_alpha = 0;                            ///< weight of the present at full speed; 0: speed does not matter
  double full_speed = 16;                            ///< px
  double anti_flicker = 0;  ///< how much alpha is attenuated near a clip event, 0 to 1 (form of Falcor's TAA)
  double reactive = 1;      ///< how much of the reactive mask counts, 0 to 1
  Weighing weighing = Weighing::none;
  double exposure = 0;  ///< stops; what weighing takes for 1

  bool operator==(const WeightParameters&) const = default;
};

}  // namespace varve
