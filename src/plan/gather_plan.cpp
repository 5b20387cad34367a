#include "plan/gather_plan.h"

#include <algorithm>

#include "base/error.h"
#include "plan/value.h"

namespace varve {
namespace {

bool every(const SequenceInfo& info, bool (*has)(const Subject&)) {
  return std::all_of(info.first.subjects.begin(), info.first.subjects.end(), has);
}

PlannedPass trajectories(const SequenceInfo& info, bool moves) {
  if (!moves) return {"trajectories", false, "no vectors, so every sample stays where it is"};
  const bool both = every(info, [](const Subject& s) { return s.backward && s.forward; });
  return {"trajectories", true,
          std::string("samples of the frames around are carried here along the vectors of their own surface") +
              (both ? "; the files have vectors in both directions"
                    : "; vectors of one direction are missing and are found in those of the neighboring frame")};
}

PlannedPass surfaces(bool ids, bool depths, Plan& plan) {
  if (!depths) {
    plan.notes.push_back(std::string("there is no depth, so the gather cannot tell what is in front: surfaces ") +
                         (ids ? "are followed by their ids, but" : "are not told apart, and") +
                         " edges of moving things mix; name the depth with --map depth=CHANNEL or --depth-file FILE");
    return {"layered coverage", false, "there is no depth to sort surfaces by"};
  }
  if (!ids)
    plan.notes.push_back(
        "there are no object ids, so the gather tells surfaces apart by depth alone; things that touch are taken for "
        "one; name ids with --map id=CHANNEL");
  return {"layered coverage", true,
          std::string("surfaces are told apart by ") + (ids ? "id and depth" : "depth") +
              ", sorted, and cover a pixel by what all frames show there"};
}

}  // namespace

std::vector<PlannedPass> gather_passes(const SequenceInfo& info, const Parameters& parameters, Plan& plan) {
  const GatherParameters& g = parameters.gather;
  if (g.gain_window % 2 == 0)
    throw Failure(ExitCode::usage, "--gain-window is the odd edge of a window, not " + std::to_string(g.gain_window));
  const bool moves = plan.use_motion;
  const bool depths = every(info, [](const Subject& s) { return s.depth.has_value(); });
  const bool ids = every(info, [](const Subject& s) { return s.id.has_value(); });
  plan.use_forward = moves;
  plan.use_depth = depths;
  plan.use_id = ids;
  plan.use_jitter = info.frames_with_jitter == int(info.frames.size());
  if (!plan.use_jitter)
    plan.notes.push_back(
        std::string("THE JITTER ") + (info.frames_with_jitter == 0 ? "IS NOT KNOWN" : "IS KNOWN FOR SOME FRAMES ONLY") +
        ": samples are taken to lie in the middle of their pixels where it is not, which costs 3 to 6 dB if the frames "
        "were jittered; give it with --jitter FILE or --jitter PATTERN:COUNT");
  std::vector<PlannedPass> passes;
  passes.push_back(trajectories(info, moves));
  passes.push_back(surfaces(ids, depths, plan));
  passes.push_back({"shading gain", g.gain,
                    g.gain ? "light that changes is measured in " + std::to_string(g.gain_window) + "x" +
                                 std::to_string(g.gain_window) +
                                 " pixels of the same surface; samples follow it, and count less where it changed"
                           : "not asked for: samples are taken as they are"});
  passes.push_back({"gather", true,
                    "up to " + std::to_string(g.reach) +
                        " frames on each side, every sample once at its true position; " + std::to_string(g.cells) +
                        "x" + std::to_string(g.cells) + " cells of equal area in a pixel"});
  return passes;
}

std::size_t gather_bytes_per_pixel(const Parameters& parameters) {
  const std::size_t frames = 2 * std::size_t(gather_reach(parameters.gather)) + 1;
  // color and border, valid, vectors both ways, depth, id, light and its range; where each sample goes
  return frames * (16 + 4 + 8 + 8 + 4 + 4 + 4 + 12) + (2 * std::size_t(parameters.gather.reach) + 1) * 12;
}

double gather_nanoseconds(const Parameters& parameters) {
  // Fitted to whole runs of the four presets on crowded scenes of 320x180: following a sample, its light, its cells.
  const double frames = 2 * parameters.gather.reach + 1, cells = parameters.gather.cells;
  return frames * (280 + (parameters.gather.gain ? 100 : 0) + cells * cells);
}

}  // namespace varve
