// Vectors that are too long for the type they are stored in.
#pragma once

#include <string>

#include "base/parallel.h"
#include "stages/source_frame.h"

namespace varve {

/// From this length on, in pixels, a half that holds pixels has steps of 1/16 px and more: history is read beside its
/// place by up to half of that.
inline constexpr double kLongForHalf = 64;

/// A sentence where vectors of a frame, as read, come from channels of half floats and reach that far; else "".
std::string half_vectors_remark(const SourceFrame& source, Workers& workers);

}  // namespace varve
