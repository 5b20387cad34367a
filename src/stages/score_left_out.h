// One resolved run judged without a reference.
#pragma once

#include <string>
#include <vector>

#include "diagnose/leave_out.h"
#include "diagnose/warped_residual.h"
#include "plan/measure_job.h"

namespace varve {

struct LeftOutScore {
  LeaveOut leave_out;
  WarpedResidual unsteady;     ///< of the output along the motion; empty where there are no vectors
  std::size_t not_finite = 0;  ///< R, G and B values of the output
};

/// `output` was written by a resolve of the job's input that keeps its channels.
LeftOutScore score_left_out(const MeasureJob& job, const SequencePattern& output, const std::vector<int>& frames,
                            Workers& workers);

}  // namespace varve
