// Error against time as a picture.
#pragma once

#include "stages/drawing.h"
#include "stages/measurement.h"

namespace varve {

/// A dot for each setting that was scored, numbered as in the table; the names stand on the right, the Pareto front is
/// a line, and what reading and writing takes is a dashed one.
Drawing trade_plot(const Measurement& m);

}  // namespace varve
