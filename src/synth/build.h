// Small makers that the scenes are written with.
#pragma once

#include <string>

#include "synth/scene.h"

namespace varve::synth {

constexpr double kDegree = 0.017453292519943295;

inline Motion rests(glm::dvec3 at) {
  return [at](double) { return Pose{at}; };
}
/// Steady: at `at` in frame 24.
inline Motion moves(glm::dvec3 at, glm::dvec3 per_frame) {
  return [at, per_frame](double time) { return Pose{at + per_frame * (time - 24)}; };
}
/// Moves, and turns back in frame 24 on the way it came.
inline Motion turns_back(glm::dvec3 at, glm::dvec3 per_frame) {
  return [at, per_frame](double time) { return Pose{at + per_frame * (time < 24 ? time - 24 : 24 - time)}; };
}
/// Turns in the plane of the picture.
inline Motion spins(glm::dvec3 at, double radians_per_frame) {
  return [at, radians_per_frame](double time) { return Pose{at, turned_z(radians_per_frame * time)}; };
}
/// The same, held as it is in frame 24.
inline Motion frozen(const Motion& motion) {
  return [pose = motion(24)](double) { return pose; };
}

inline CameraMotion camera_rests() {
  return [](double) { return Camera{}; };
}

/// A wide wall at this distance.
Surface wall(double distance, const Texture& texture);
/// A level floor `below` the camera.
Surface ground(double below, const Texture& texture);
Surface rectangle(const std::string& name, double half_width, double half_height, const Texture& texture,
                  Motion motion);
Surface disc(const std::string& name, double radius, const Texture& texture, Motion motion);
Surface ball(const std::string& name, double radius, const Texture& texture, Motion motion);

Texture bricks(double size = 40);
Texture noise(glm::dvec3 first, glm::dvec3 second, double size, std::uint64_t seed);

/// One shot with a resting camera; add to `shots[0]`.
Scene one_shot(CameraMotion camera = camera_rests());
/// Numbers the objects of all shots from 1 and says whether the vectors are right.
Scene finished(Scene scene);

}  // namespace varve::synth
