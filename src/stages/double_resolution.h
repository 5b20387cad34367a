// The picture at twice the resolution of the frames: each quarter of a pixel as a pixel of its own.
#pragma once

#include <functional>
#include <vector>

#include "exr/read_frame.h"
#include "plan/probe.h"
#include "stages/write_resolved.h"

namespace varve {

/// What is written of these colors, at the size of the frame.
using PartsOf = std::function<FileOutput(const std::vector<ResolvedSubject>&)>;

/// What parts_of() makes of the quarters, side by side: windows are doubled, pixel (2x, 2y) is the quarter left above
/// of pixel (x, y). What does not differ between quarters is repeated 2x2, bit for bit, but for vectors of
/// headers.subjects that count pixels, which are doubled. Parts that would be copied are read and repeated too, since
/// all parts of a file have one display window. The frame's jitter is left out, being that of one sample.
/// Every color must have its quarters. Throws Failure(inconsistent) where a deep part would be copied, and what
/// read_channels throws.
FileOutput double_resolution(const FrameHeaders& headers, const FramePixels& pixels,
                             const std::vector<ResolvedSubject>& resolved, const PartsOf& parts_of, Workers& workers);

}  // namespace varve
