// The least that any resolve costs: the same channels read and written, and nothing done with them.
#pragma once

#include "plan/resolve_job.h"

namespace varve {

/// Reads and writes the frames of the job: what a resolve that keeps every channel reads and writes, with the same
/// compression. Throws Failure.
void copy_sequence(const ResolveJob& job);

}  // namespace varve
