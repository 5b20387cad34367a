// What pixels lack, pixel by pixel and in double: the slow twin of rerender/evaluation.h.
#pragma once

#include "rerender/evaluation.h"

namespace varve::test {

struct EvaluatedPixel {
  double lacking = 0, count = 0, variance = 0;
  bool failed = false;
};

EvaluatedPixel evaluate_pixel(const Present& present, const Accumulated& resolved, const RerenderRequest& request,
                              int x, int y);

}  // namespace varve::test
