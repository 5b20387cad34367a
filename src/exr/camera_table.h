// A file with the camera of each frame, for `--camera FILE`.
#pragma once

#include <map>
#include <string>

#include "exr/camera_source.h"

namespace varve {

/// CSV with a header line: frame,v0,...,v15 and then either p0,...,p15 or focal,aperture; blank lines and lines that
/// begin with # do not count. Or JSON: a list of objects (or an object with such a list as `frames`) with the members
/// frame, view (16 numbers) and either proj (16) or focal and aperture. Throws Failure(usage) when there is no such
/// file, Failure(input) with line or entry otherwise.
std::map<int, CameraRow> read_camera_table(const std::string& path);

}  // namespace varve
