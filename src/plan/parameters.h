// Everything that can be tuned: the parameter structs of the passes, together.
#pragma once

#include <string>

#include "motion/motion.h"
#include "resolve/accumulate.h"
#include "resolve/sharpen.h"

namespace varve {

struct Parameters {
  std::string preset = "salvi";  ///< where the values came from before the user changed any
  MotionParameters motion;
  RecursiveParameters recursive;
  RectifyParameters rectify;
  FinishParameters finish;
};

}  // namespace varve
