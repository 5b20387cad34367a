// A page to read first: frames in common -> per frame: shape, pixels, values, colors, change over time -> verdict.
#pragma once

#include <functional>

#include "plan/compare_job.h"
#include "stages/comparison.h"

namespace varve {

struct CompareEvents {
  std::function<void(int done, int total)> frame;
  std::function<bool()> should_stop;  ///< looked at between frames
};

/// Compares what both sequences have. Sides that do not fit together are a verdict with a reason; Failure is thrown for
/// files that are missing on both sides or cannot be read, and for heat maps that cannot be written.
Comparison compare_sequence(const CompareJob& job, const CompareEvents& events);

}  // namespace varve
