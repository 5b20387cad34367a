#include "exr/jitter_convention.h"

#include <algorithm>

namespace varve {
namespace {

constexpr JitterConvention kConventions[] = {
    {"pixels", "jx", "jy",
     "Sample position minus pixel center in pixels, x right, y down, from -0.5 to 0.5. `varve resolve --jitter FILE` "
     "reads these and no others. Motion vectors must not contain the jitter.",
     "definition", false, [](Jitter j, double, double) { return j; }},
    {"ndc", "ndc_x", "ndc_y",
     "Translation in normalized device coordinates (-1 to 1, y up) to multiply onto the projection from the left: "
     "-2 jx / width, 2 jy / height. The picture moves against the sample, hence the signs. In an OpenGL matrix (w is "
     "-z) subtract them from the elements [0][2] and [1][2]. Half a pixel is 1 / width here. An offset of 0.5 / width "
     "in such a matrix is a quarter of a pixel, so a pattern of -0.5 to 0.5 divided by the width covers half of the "
     "pixel on each axis and a quarter of its area.",
     "definition", true,
     [](Jitter j, double w, double h) {
       return Jitter{-2 * j.x / w, 2 * j.y / h};
     }},
    {"cycles", "shift_x", "shift_y",
     "Blender: shift_x and shift_y of the camera: jx / m, -jy / m, where m is the larger side in pixels (sensor fit "
     "auto, square pixels). Pixel filter box with a width of 0.01, so that the samples lie where the shift says. Set "
     "by "
     "a script before each frame, not animated, the shift stays out of the vector pass.",
     "measured", true,
     [](Jitter j, double w, double h) {
       return Jitter{j.x / std::max(w, h), -j.y / std::max(w, h)};
     }},
    {"arnold", "screen_window_x", "screen_window_y",
     "Arnold: add to screen_window_min and screen_window_max of the camera: 2 jx / width, -2 jy / height (the window "
     "is "
     "-1 to 1 on both axes, y up). One camera sample with a narrow box filter, or the samples fill the pixel as well.",
     "documented", true,
     [](Jitter j, double w, double h) {
       return Jitter{2 * j.x / w, -2 * j.y / h};
     }},
    {"renderman", "screen_window_x", "screen_window_y",
     "RenderMan: add to left and right, and to bottom and top, of ScreenWindow: 2 jx / m, -2 jy / m, where m is the "
     "smaller side in pixels (the window is -1 to 1 along it, y up). Pixel filter box with a small width.",
     "documented", true,
     [](Jitter j, double w, double h) {
       return Jitter{2 * j.x / std::min(w, h), -2 * j.y / std::min(w, h)};
     }},
};

}  // namespace

std::span<const JitterConvention> jitter_conventions() { return kConventions; }

}  // namespace varve
