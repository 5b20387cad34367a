// PNG pictures of colors and diagnostic planes. OpenImageIO does the work, from a module that is loaded on first use,
// because linking it would cost every process a quarter of a second.
#pragma once

#include <string>

#include <glm/vec4.hpp>

#include "base/plane.h"
#include "exr/color_space.h"

namespace varve {

/// Writes `values` (over their window) as an 8-bit PNG through the OpenImageIO color map named, `low` and `high` at its ends.
/// Non-finite values take the nearer end, NaN the low one. Throws Failure(output) with the path, or when the module cannot be loaded.
void write_map_png(const std::string& path, const Plane<float>& values, const std::string& colormap, double low, double high);

/// Writes a scene-linear premultiplied RGBA plane as an 8-bit PNG: through the display transform if there is one, else sRGB.
void write_color_png(const std::string& path, const Plane<glm::vec4>& color, const DisplayTransform* transform);

}  // namespace varve
