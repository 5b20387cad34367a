// A page to read first: settings -> timed runs of the program, interleaved -> scores -> Pareto front, recommendation.
#pragma once

#include <functional>
#include <string>

#include "plan/measure_job.h"
#include "stages/measurement.h"

namespace varve {

struct MeasureEvents {
  std::function<void(const std::string& what, int done, int total)> step;
  std::function<bool()> should_stop;  ///< looked at between runs
  std::function<void(const std::string& sentence)> warning;
};

/// Throws Failure: inconsistent when reference and input have nothing in common, what a run ended with otherwise.
Measurement measure_sequence(const MeasureJob& job, const MeasureEvents& events);

}  // namespace varve
