// Where what samples have become is written.
#pragma once

#include <vector>

#include "exr/read_frame.h"
#include "exr/write_frame.h"
#include "plan/probe.h"

namespace varve {

/// `parts` refer to headers.files, as shown. Afterwards they refer to the file on disk, with the windows of the result
/// where that was a grid; parts that were samples lose their number and the place of that one sample in the pixel.
void place_samples(const FrameHeaders& headers, std::vector<OutputPart>& parts);

/// Vectors that count pixels, of the samples of a grid that are passed on: divided by n, since pixels have grown. Call
/// it when nothing but writing is left to do with `pixels`.
void divide_passed_vectors(const FrameHeaders& headers, FramePixels& pixels, Workers& workers);

/// bias + (v - bias) / by for every value of a channel, held at the ends of half; integers stay.
void divide_around(RawPlane& plane, double bias, double by, Workers& workers);

}  // namespace varve
