#include "plan/camera_plan.h"

#include <algorithm>

namespace varve {
namespace {

/// What the main camera does between frames that follow each other.
struct Moves {
  bool turns = false, zooms = false;
};

Moves moves_of(const CameraTrack& track) {
  Moves moves;
  const Camera* last = nullptr;
  for (const auto& [frame, row] : track) {
    const Camera* now = row.cameras.front() ? &*row.cameras.front() : nullptr;
    if (now && last) {
      moves.turns = moves.turns || glm::dmat3(now->to_camera) != glm::dmat3(last->to_camera);
      moves.zooms = moves.zooms || now->focal != last->focal;
    }
    last = now;
  }
  return moves;
}

bool has_vectors(const Subject& s) { return s.backward || s.forward; }

}  // namespace

bool is_moved_by_camera(const SequenceInfo& info, const Subject& subject) {
  const std::vector<Subject>& subjects = info.first.subjects;
  const auto found = std::find_if(subjects.begin(), subjects.end(), [&](const Subject& s) { return &s == &subject; });
  if (found == subjects.end() || has_vectors(subject) || !subject.depth) return false;
  const auto place = std::size_t(found - subjects.begin());
  return info.cameras.size() == info.frames.size() &&
         std::all_of(info.cameras.begin(), info.cameras.end(), [&](const auto& row) {
           return place < row.second.cameras.size() && row.second.cameras[place].has_value();
         });
}

std::size_t moved_by_camera(const SequenceInfo& info) {
  return std::size_t(std::count_if(info.first.subjects.begin(), info.first.subjects.end(),
                                   [&](const Subject& s) { return is_moved_by_camera(info, s); }));
}

PlannedPass camera_pass(const SequenceInfo& info, const Parameters& parameters, Plan& plan) {
  const auto idle = [](std::string reason) { return PlannedPass{"camera", false, std::move(reason)}; };
  const MotionParameters& motion = parameters.motion;
  const bool ray = motion.depth_kind == DepthKind::ray;
  if (info.frames_with_camera == 0) {
    if (ray) plan.notes.push_back("no camera is known, so ray distances stay as they are");
    return idle("no camera is known");
  }
  const std::size_t made = moved_by_camera(info);
  const bool depth = std::any_of(info.first.subjects.begin(), info.first.subjects.end(),
                                 [](const Subject& s) { return s.depth.has_value(); });
  const bool completes = motion.camera != CameraUse::missing && depth &&
                         std::any_of(info.first.subjects.begin(), info.first.subjects.end(),
                                     [](const Subject& s) { return has_vectors(s) && s.depth; });
  const Moves moves = moves_of(info.cameras);
  plan.use_cameras = made > 0 || completes || (ray && depth);
  if (made > 0)
    plan.notes.push_back(
        "vectors are made from depth and cameras, as if all rested in the world: what moves by itself is followed "
        "wrongly");
  if (info.frames_with_camera < int(info.frames.size()))
    plan.notes.push_back("the camera is known for " + std::to_string(info.frames_with_camera) + " of " +
                         std::to_string(info.frames.size()) + " frames only; it says nothing of the others");
  if (!plan.use_cameras) {
    if (motion.camera == CameraUse::missing && depth && (moves.turns || moves.zooms)) {
      const std::string what = moves.turns ? "turns" : "zooms";
      return idle("there are vectors; the camera " + what + ", so --camera-motion all would help a textured sky" +
                  (moves.zooms ? ", and zoom that the vectors lack" : ""));
    }
    return idle(depth ? "there are vectors" : "there is no depth");
  }
  const bool background = motion.camera == CameraUse::background || motion.camera == CameraUse::all;
  const bool zoom = motion.camera == CameraUse::zoom || motion.camera == CameraUse::all;
  // Dilation tells surfaces from background by it.
  const bool apart =
      completes && background && motion.dilation == Dilation::longest && parameters.accumulator != Accumulator::gather;
  plan.use_depth = plan.use_depth || apart;
  std::string what;
  const auto add = [&](bool used, const std::string& text) {
    if (used) what += (what.empty() ? "" : "; ") + text;
  };
  add(made > 0, "vectors are made from depth");
  add(completes && background, std::string("background whose vectors are zero moves with the camera, which ") +
                                   (moves.turns ? "turns" : "does not turn in these frames") +
                                   (apart ? "; where both meet, pixels follow the surface" : ""));
  add(completes && zoom,
      std::string("zoom and lens shift are added where the vectors of what rests are found to lack them") +
          (moves.zooms ? "" : "; the focal length does not change in these frames"));
  add(ray && depth, "ray distances become planar");
  return {"camera", true, info.camera + ": " + what};
}

}  // namespace varve
