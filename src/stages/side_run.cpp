#include "stages/side_run.h"

#include <limits>
#include <utility>

#include "base/reject.h"
#include "motion/dilate.h"

namespace varve {
namespace {

/// What the report needs.
MotionRepair counts_of(const MotionRepair& said) {
  MotionRepair counts;
  counts.census = said.census, counts.count = said.count;
  return counts;
}

/// Puts the motion of this side into the presents, and passes each to `step(k, present, state)`.
template <class Step>
void pass_subjects(SideRun& run, SourceFrame& source, const SharedVectors& vectors, const Parameters& parameters,
                   Workers& workers, Step step) {
  run.states.resize(source.presents.size());
  source.repairs.resize(source.presents.size());
  for (std::size_t k = 0; k < source.presents.size(); ++k) {
    Present& present = source.presents[k];
    const SideVectors* neighbor = run.neighbor ? &(*run.neighbor)[k] : nullptr;
    MotionRepair said;
    DilatedMotion dilated = motion_to(run.side, (*vectors)[k], neighbor, parameters, said, workers);
    if (run.side == Side::past)
      source.repairs[k] = std::move(said);
    else
      source.forward_repairs.push_back(counts_of(said));
    present.motion = std::move(dilated.motion);
    present.depth = std::move(dilated.depth);
    present.id = std::move(dilated.marks.id);
    present.normal = std::move(dilated.marks.normal);
    run.states[k] = step(k, present, run.states[k]);
  }
  run.neighbor = vectors;
}

SeenFrame view(const SideVectors& frame) {
  return SeenPlanes::seen_frame(frame.light, frame.depth, frame.marks.id, frame.jitter);
}

}  // namespace

SharedVectors take_vectors(SourceFrame& source, const RepairParameters& repair, Workers& workers) {
  auto vectors = std::make_shared<std::vector<SideVectors>>();
  for (std::size_t k = 0; k < source.presents.size(); ++k) {
    Present& present = source.presents[k];
    vectors->push_back({std::move(present.motion),
                        std::move(present.forward),
                        std::move(present.depth),
                        {std::move(present.id), std::move(present.normal)},
                        repair.mode == RepairMotion::off ? Plane<float>() : light_of(present.color, workers),
                        present.jitter.value_or(glm::dvec2(0)),
                        cameras_of(source, k)});
  }
  return vectors;
}

DilatedMotion motion_to(Side side, const SideVectors& here, const SideVectors* neighbor, const Parameters& parameters,
                        MotionRepair& said, Workers& workers) {
  const bool past = side == Side::past;
  const Plane<glm::vec2>&own = past ? here.backward : here.forward, &opposite = past ? here.forward : here.backward;
  SurfaceMarks marks{here.marks.id.clone(), here.marks.normal.clone()};
  if (own.empty() && opposite.empty()) return {{}, here.depth.clone(), std::move(marks)};

  const Plane<glm::vec2> none;
  const Plane<glm::vec2>& back = !neighbor ? none : past ? neighbor->forward : neighbor->backward;
  const bool test = neighbor && !here.light.empty();
  const auto resting = [&](const SideVectors& from, Side to) {
    const CamerasAround& cameras = from.cameras;
    return resting_motion(to == Side::past ? cameras.before : cameras.after, from.depth, from.jitter, workers);
  };
  Plane<glm::vec2> motion, repaired;
  if (!own.empty()) {
    motion = own.clone();
    if (test)
      said = repair_motion(motion, view(here), view(*neighbor), back, resting(here, side), parameters.repair, workers);
    if (test) repaired = motion.clone();
  } else {
    motion = Plane<glm::vec2>(opposite.window(), 0, glm::vec2(std::numeric_limits<float>::quiet_NaN()));
    Plane<glm::vec2> leading_here = back.clone();
    if (test && !back.empty()) {
      said = repair_motion(leading_here, view(*neighbor), view(here), none,
                           resting(*neighbor, past ? Side::future : Side::past), parameters.repair, workers);
      said.residual = {}, said.how = {};  // of the neighbor's pixels
    }
    if (!back.empty())
      motion = invert_motion(leading_here, neighbor->depth, here.depth, parameters.recursive.depth_tolerance,
                             std::move(motion));
  }
  // Before dilation: what leads nowhere may follow a neighbor that does not.
  const double tolerance = parameters.two_sided.return_tolerance;
  if (tolerance > 0 && !back.empty() && !own.empty()) {
    reject_one_way_motion(motion, back, tolerance, workers);
    if (!repaired.empty()) keep_repaired(motion, repaired, said, workers);
  }
  const auto dilate = moves_background(parameters.motion.camera) ? dilate_surfaces_apart : dilate_motion;
  return dilate(std::move(motion), here.depth, parameters.motion.dilation, workers, std::move(marks));
}

std::vector<StrictSide> pass_frame(SideRun& run, SourceFrame& source, const SharedVectors& vectors,
                                   const StepOptions& options, Workers& workers) {
  const Parameters& p = options.parameters;
  std::vector<StrictSide> strict;
  pass_subjects(run, source, vectors, p, workers, [&](std::size_t, const Present& present, const History& state) {
    SideStep step =
        accumulate_side(present, state, p.recursive, p.rectify, present.jitter, kRejectCut, options.wanted, workers);
    strict.push_back(std::move(step.strict));
    return std::move(step.state);
  });
  return strict;
}

std::vector<Accumulated> merge_frame(SideRun& run, SourceFrame& source, const SharedVectors& vectors,
                                     const std::vector<StrictSide>& others, const StepOptions& options,
                                     Workers& workers) {
  const Parameters& p = options.parameters;
  std::vector<Accumulated> resolved;
  pass_subjects(run, source, vectors, p, workers, [&](std::size_t k, const Present& present, const History& state) {
    MergedStep step = accumulate_both(present, state, others[k], p.recursive, p.rectify, present.jitter, kRejectCut,
                                      options.wanted, workers);
    resolved.push_back(std::move(step.resolved));
    return std::move(step.state);
  });
  return resolved;
}

}  // namespace varve
