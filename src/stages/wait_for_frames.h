// Frames that a renderer has not finished yet (--wait).
#pragma once

#include <functional>
#include <string>

#include "plan/resolve_job.h"

namespace varve {

/// Returns when every requested frame is there with all its role files, or when `stop` says so. A file is taken when
/// its header and chunk tables are whole and it rests: not changed for two seconds, or between two looks. `tell` hears
/// what is waited for whenever that changes. Nothing to do where job.wait_seconds is 0. Throws Failure(input) naming
/// the first frame that is missing when nothing has changed for job.wait_seconds, Failure(usage) where no frames are
/// requested by number: what is not there cannot be listed.
void wait_for_frames(const ResolveJob& job, const std::function<void(const std::string&)>& tell,
                     const std::function<bool()>& stop);

}  // namespace varve
