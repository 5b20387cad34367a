// Where two pictures differ, as pictures.
#pragma once

#include <string>

#include "stages/read_pair.h"

namespace varve {

/// The FLIP map of a pair, 0 same, 1 worst; HDR-FLIP where the reference leaves the range 0..1.
Plane<float> heat_map(const ColorPair& pair, Workers& workers);

/// Writes FOLDER/heat.<frame>.exr (float: difference.R, G, B as B minus A, and heat) and FOLDER/heat.<frame>.png. With
/// several colors the name has the layer in front. Throws Failure(output).
void write_heat_maps(const CompareJob& job, const FramePair& pair, const SubjectPair& subject, const ColorPair& colors,
                     Workers& workers);

}  // namespace varve
