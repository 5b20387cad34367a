// PNG pictures of colors and diagnostic planes. OpenImageIO does the work, from a module that is loaded on first use,
// because linking it would cost every process a quarter of a second.
#pragma once

#include <string>

#include <glm/vec4.hpp>

#include "base/plane.h"
#include "exr/color_space.h"

namespace varve {

/// Writes `values` (over their window) as an 8-bit PNG through the OpenImageIO color map named, `low` and `high` at its
/// ends. Non-finite values take the nearer end, NaN the low one. Throws Failure(output) with the path (the file appears
/// only when complete), or when the module cannot be loaded. The module is looked for in the folders of
/// $VARVE_MODULE_PATH, then beside the program.
void write_map_png(const std::string& path, const Plane<float>& values, const std::string& colormap, double low,
                   double high);

/// Writes a scene-linear premultiplied RGBA plane as an 8-bit PNG: as over black, through the display transform if
/// there is one, else sRGB. The picture has no alpha. NaN is black. Throws like write_map_png.
void write_color_png(const std::string& path, const Plane<glm::vec4>& color, const DisplayTransform* transform);

}  // namespace varve
