// What is wrong with stored vectors, in words.
#pragma once

#include <string>
#include <vector>

#include "stages/probe_motion.h"

namespace varve {

/// Zero, constant, clamped, premultiplied, antialiased, too long for half, missing on what moves; a sentence each.
/// `headers` are those of a frame of the sequence.
std::vector<std::string> vector_findings(const VectorLayer& layer, const VectorReport& report,
                                         const FrameHeaders& headers, const Window& display);

}  // namespace varve
