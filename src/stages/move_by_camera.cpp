#include "stages/move_by_camera.h"

#include <cmath>

#include "base/error.h"
#include "motion/camera_vectors.h"

namespace varve {
namespace {

/// One direction of time.
struct Way {
  const std::optional<CameraChange>& change;
  const std::optional<int>& neighbor;
  Plane<glm::vec2>& motion;
};

bool uses(CameraUse asked, CameraUse use) { return asked == CameraUse::all || asked == use; }

/// What rests in the world; behind an orthographic camera there is one color in every direction, so it may rest.
Plane<glm::vec2> made_motion(const Plane<float>& depth, glm::dvec2 jitter, const CameraChange& change,
                             double max_length, Workers& workers) {
  Plane<glm::vec2> motion = camera_motion(depth, jitter, change, max_length, workers);
  if (change.from.projection == Projection::perspective && change.to.projection == Projection::perspective)
    return motion;
  const Window& w = motion.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int i = 0; i < w.width(); ++i)
      if (std::isinf(depth.row(y)[i])) motion.row(y)[i] = glm::vec2(0.0f);
  return motion;
}

void make(const Way& way, const Plane<float>& depth, glm::dvec2 jitter, double max_length, CameraVectors& counts,
          bool counted, Workers& workers) {
  if (!way.neighbor) return;
  if (!way.change)
    throw Failure(ExitCode::inconsistent,
                  "its vectors are to be made from cameras, but there is none for it or for frame " +
                      std::to_string(*way.neighbor) + "; give cameras with --camera FILE, or name motion vectors");
  way.motion = made_motion(depth, jitter, *way.change, max_length, workers);
  if (counted) counts.made += depth.window().pixels();
}

std::string share(std::size_t part, std::size_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole) + " pixels looked at";
}

void complete(const Way& way, const Plane<float>& depth, glm::dvec2 jitter, const MotionParameters& parameters,
              CameraVectors& counts, bool counted, Workers& workers) {
  if (!way.change || way.change->rests || way.motion.empty()) return;
  const CameraChange& change = *way.change;
  CameraFill fill{uses(parameters.camera, CameraUse::background), uses(parameters.camera, CameraUse::zoom)};
  fill.lens = fill.lens && !change.lens_rests;
  if (!fill.background && !fill.lens) return;
  const CameraEvidence evidence = compare_with_camera(way.motion, depth, jitter, change);
  if (contradicts(evidence)) {
    counts.remark = "the vectors contradict the cameras (" + share(evidence.agree, evidence.looked_at) +
                    " move as they say), so the cameras are not used";
    if (all_zero(evidence))
      counts.remark =
          "every vector is zero while the camera moves, so nothing bears the cameras out; Cycles writes such vectors "
          "when motion blur is on: with --convention none vectors are made from depth and cameras";
    return;
  }
  if (fill.lens && lens_is_unclear(evidence))
    counts.remark = "the lens changes, but whether the vectors know of it is not clear (" +
                    share(evidence.with_lens, evidence.lens_tested) + " say yes, " +
                    std::to_string(evidence.without_lens) + " no), so nothing is added";
  fill.lens = fill.lens && lacks_lens(evidence);
  const CameraFilled filled = complete_vectors(way.motion, depth, jitter, change, fill, parameters.max_length, workers);
  if (!counted) return;
  counts.background += filled.background;
  counts.lens += filled.lens;
}

}  // namespace

void move_by_camera(Present& present, const Subject& subject, const CamerasAround& cameras,
                    const NeighborFrames& neighbors, const MotionParameters& parameters, bool want_forward,
                    CameraVectors& counts, Workers& workers) {
  if (present.depth.empty()) return;
  counts.pixels += present.depth.window().pixels();
  const glm::dvec2 jitter = present.jitter.value_or(glm::dvec2(0));
  const Way before{cameras.before, neighbors.before, present.motion};
  const Way after{cameras.after, neighbors.after, present.forward};
  if (!subject.backward && !subject.forward) {
    make(before, present.depth, jitter, parameters.max_length, counts, true, workers);
    if (want_forward) make(after, present.depth, jitter, parameters.max_length, counts, false, workers);
    return;
  }
  if (parameters.camera == CameraUse::missing) return;
  complete(before, present.depth, jitter, parameters, counts, true, workers);
  complete(after, present.depth, jitter, parameters, counts, !subject.backward, workers);
}

}  // namespace varve
