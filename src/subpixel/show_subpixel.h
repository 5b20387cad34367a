// The picture that four sub-pixel histories make.
#pragma once

#include "subpixel/accumulate_subpixel.h"

namespace varve {

/// Fills step.resolved.history, and quarters and planes where they are wanted, from step.history, which has the present
/// in it. diagnostics.weight must be that of the quarter that was added last.
void show_subpixel(const Present& present, const SubpixelParameters& subpixel, const RecursiveParameters& recursive,
                   const DiagnosticsWanted& wanted, SubpixelStep& step, Workers& workers);

}  // namespace varve
