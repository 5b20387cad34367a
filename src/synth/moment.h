// A scene as one frame sees it, ready to be asked at any position.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "synth/scene.h"

namespace varve::synth {

/// Depth of what is infinitely far away or not there, as renderers write it.
inline constexpr double kFarDepth = 1e10;

/// What one position sees.
struct Sample {
  glm::dvec3 color{0};  ///< scene-linear, premultiplied
  double alpha = 0;
  double depth = kFarDepth;  ///< planar, of the first surface met
  glm::dvec2 backward{0};    ///< pixels, y down: position of the same point in the previous frame minus this one
  glm::dvec2 forward{0};     ///< and in the next frame minus this one
  double depth_before = 0, depth_after = 0;  ///< planar depths of that point in those frames; <= 0: behind the camera
  unsigned id = 0;
  glm::dvec2 material{0};  ///< coordinates on the surface: the same point has the same ones at any time
  const Surface* surface = nullptr;
};

/// One surface with its transforms at a frame.
struct PlacedSurface {
  const Surface* surface = nullptr;
  glm::dmat3 to_local;       ///< flat: pixel (x, y, 1) to (u, v, 1) * q; depth = 1 / q
  glm::dvec3 center;         ///< sphere: in camera coordinates
  glm::dmat3 rotation;       ///< local to camera
  glm::dmat3 before, after;  ///< local to homogeneous pixels of the frames beside, as the vectors say
  glm::dvec3 before_offset, after_offset;
  bool rests_before = false, rests_after = false;  ///< vectors are zero, to the last bit
  glm::dvec4 bounds{-1e30, -1e30, 1e30, 1e30};     ///< pixels x0, y0, x1, y1 outside of which it is not
  double brightness = 1;
};

struct PlacedSpot {
  glm::dvec3 center, inverse_radii;  ///< center in camera coordinates
  double amount = 0;
};

/// Keeps pointers into the scene, which must outlive it.
struct Moment {
  double time = 0;
  glm::dmat3 to_ray;    ///< pixel (x, y, 1) to the camera ray with z = 1
  glm::dmat3 to_world;  ///< camera directions to world
  Camera camera;
  std::vector<PlacedSurface> surfaces;
  std::vector<PlacedSpot> spots;
};

/// The scene at `frame`, for a picture of this size. With a layer only its surfaces are there.
Moment moment_of(const Scene& scene, int frame, int width, int height, std::optional<Layer> layer = std::nullopt);

/// Everything at pixel position (x, y); y down, pixel centers at .5, anywhere inside or outside the picture.
/// `chance` decides over stochastic surfaces; without it they count with their opacity, as in the limit of many
/// samples.
Sample evaluate(const Moment& moment, double x, double y, std::optional<std::uint64_t> chance = std::nullopt);

/// Color and alpha only: what truth needs, in less time.
Sample evaluate_color(const Moment& moment, double x, double y);

}  // namespace varve::synth
