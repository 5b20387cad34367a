#include "stages/repair_vectors.h"

#include <cmath>

namespace varve {

SeenPlanes seen_planes(const Present& present, const CamerasAround& cameras, const RepairParameters& parameters,
                       Workers& workers) {
  if (parameters.mode == RepairMotion::off) return {};
  return {light_of(present.color, workers), present.depth.clone(), present.id.clone(),
          present.jitter.value_or(glm::dvec2(0)), cameras};
}

Plane<glm::vec2> resting_motion(const std::optional<CameraChange>& change, const Plane<float>& depth, glm::dvec2 jitter,
                                Workers& workers) {
  if (!change || depth.empty()) return {};
  return camera_motion(depth, jitter, *change, std::hypot(depth.window().width(), depth.window().height()), workers);
}

void keep_repaired(Plane<glm::vec2>& tested, const Plane<glm::vec2>& repaired, const MotionRepair& repair,
                   Workers& workers) {
  if (repair.how.empty()) return;
  const Window& w = tested.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x)
      if (repair.how.at(x, y) != std::uint8_t(RepairedBy::kept)) tested.at(x, y) = repaired.at(x, y);
  });
}

}  // namespace varve
