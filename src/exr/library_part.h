// Parts that go through the OpenEXR C++ API: every flat part that is not uncompressed, ZIP or ZIPS scan lines.
#pragma once

#include <string>
#include <vector>

#include "base/raw_plane.h"
#include "exr/file_header.h"

namespace varve {

/// Fills the planes that are not empty (one per channel of the part) with `threads` threads. Tiles: full resolution.
/// Throws Failure(input) naming the part.
void read_part_by_library(const FileHeader& header, int part, std::vector<RawPlane>& planes, int threads);

/// What the library said, fit for one of our sentences; empty when it says nothing that helps.
std::string library_reason(const char* what);

}  // namespace varve
