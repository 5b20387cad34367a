// Everything that can be tuned: the parameter structs of the passes, together.
#pragma once

#include <string>

#include "gather/gather.h"
#include "motion/motion.h"
#include "motion/repair_motion.h"
#include "resolve/accumulate.h"
#include "resolve/fallback.h"
#include "resolve/sharpen.h"
#include "resolve/two_sided.h"
#include "subpixel/subpixel_history.h"

namespace varve {

struct Parameters {
  std::string preset = "salvi";  ///< where the values came from before the user changed any
  Accumulator accumulator = Accumulator::recursive;
  MotionParameters motion;
  RepairParameters repair;
  RecursiveParameters recursive;
  RectifyParameters rectify;
  FallbackParameters fallback;
  FinishParameters finish;
  GatherParameters gather;
  TwoSidedParameters two_sided;
  SubpixelParameters subpixel;
};

}  // namespace varve
