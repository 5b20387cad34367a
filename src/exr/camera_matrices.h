// From the matrices that files hold to a camera, or to the reason why they are none.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>

#include "base/window.h"
#include "motion/camera.h"

namespace varve {

/// A camera, or why there is none; with a camera, what was assumed.
struct MadeCamera {
  std::optional<Camera> camera;
  std::string problem;
};

/// From a world-to-camera matrix (camera space x right, y down, z along the view, in any unit) and the matrix from
/// there to (x, y, -, w) of the picture, where (0, 0) and (1, 1) are the upper left and lower right corners of the
/// display window. Both for column vectors.
MadeCamera make_camera(glm::dmat4 to_camera, glm::dmat4 to_picture, const Window& display);

/// The standard attributes, 16 numbers each, for row vectors; either may be empty. worldToNDC alone tells a perspective
/// camera. One that spans -1 to 1 with y up, as some writers have it, is told from one that spans 0 to 1 by where the
/// view axis meets it.
MadeCamera camera_from_attributes(std::span<const double> world_to_camera, std::span<const double> world_to_ndc,
                                  const Window& display);

/// OpenGL's: row major, for column vectors, camera looking along -z, clip space -1 to 1 with y up.
MadeCamera camera_from_opengl(std::span<const double> view, std::span<const double> projection, const Window& display);

/// The same with a focal length and the width of the film, in one unit, in place of a projection; `pixel_aspect` is the
/// width of a pixel by its height.
MadeCamera camera_from_film(std::span<const double> view, double focal, double aperture, double pixel_aspect,
                            const Window& display);

}  // namespace varve
