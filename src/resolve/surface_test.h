// Whether what a history holds is the surface that a pixel of the present shows.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "base/plane.h"
#include "resolve/present.h"
#include "resolve/reject.h"

namespace varve {

/// What the present and a history know both.
struct SurfaceTests {
  bool depth = false, normal = false, id = false;
  double depth_tolerance = 0;  ///< relative
  bool any() const { return depth || normal || id; }
};

/// What a pixel of the present is compared by.
struct TestedSurface {
  bool depth, normal, id;
  double z, z_tolerance, slope_tolerance, least_cosine;
  glm::vec3 n;
  std::uint32_t name;
};
TestedSurface surface_at(const Present& present, const SurfaceTests& tests, const RejectParameters& reject, int x,
                         int y);

/// Tests that a pixel of a history fails, as reject bits. Planes that are not tested may be empty.
unsigned failed_tests(const TestedSurface& surface, const Plane<float>& depth, const Plane<glm::vec3>& normal,
                      const Plane<std::uint32_t>& id, int x, int y);

}  // namespace varve
