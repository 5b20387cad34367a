// A scene: what is there at any time. Everything is a function of time, so that any sub-pixel position at any time, and
// the way of every point to the frames beside it, are exact.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "synth/surface.h"

namespace varve::synth {

/// A soft ellipsoid in which every surface is brightened or, with a negative amount, shaded: light and shadow without
/// motion vectors. Factor 1 + amount * (1 - r^2)^2, r = 1 at the radii.
struct Spot {
  std::function<glm::dvec3(double time)> center;
  glm::dvec3 radii{100};
  std::function<double(double time)> amount;
};

/// A camera and what it sees, from a frame on until the next shot.
struct Shot {
  int first_frame = 0;
  CameraMotion camera;
  std::vector<Surface> surfaces;
  std::vector<Spot> spots;
};

struct Scene {
  std::string name;
  std::string provokes;  ///< one sentence
  int width = 320, height = 180, frames = 48;
  bool right_vectors = true;  ///< every vector is exact
  std::vector<Shot> shots;    ///< ascending; the first one also serves all frames before it
};

/// The shot of a frame.
const Shot& shot_of(const Scene& scene, int frame);

}  // namespace varve::synth
