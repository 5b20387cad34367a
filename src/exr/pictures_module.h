// The C face of the picture module, which carries OpenImageIO and is loaded only when a picture is wanted.
// Both functions return 0 when the file `path` is complete, else leave a reason (terminated, cut to `room`) in
// `reason`.
#pragma once

#include <cstddef>

extern "C" {

/// Linear RGB of `count` values in 0..1 through a color map that OpenImageIO knows; `rgb` has room for 3 * count
/// floats.
using varve_color_map_v1 = int(const float* values, int count, const char* colormap, float* rgb, char* reason,
                               std::size_t room);

/// `rgb`: width * height * 3 bytes, sRGB or display encoded, rows packed.
using varve_write_png_v1 = int(const char* path, const unsigned char* rgb, int width, int height, char* reason,
                               std::size_t room);
}
