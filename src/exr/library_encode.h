// Parts whose compression is left to the OpenEXR C++ API.
#pragma once

#include <vector>

#include "exr/container.h"

namespace varve {

/// Encodes the part as a file of its own, held in memory, whose chunks can then be copied into the output. The library
/// writes whole files only, and the output's other parts and attributes must stay the bytes they were.
/// `planes` in the order of part.channels. Throws Failure(output).
Container encode_by_library(const Part& part, const std::vector<const RawPlane*>& planes, int threads);

}  // namespace varve
