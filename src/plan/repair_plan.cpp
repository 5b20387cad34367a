#include "plan/repair_plan.h"

#include <algorithm>

namespace varve {

bool repair_uses_cameras(const SequenceInfo& info) {
  return info.frames_with_camera > 0 &&
         std::all_of(info.first.subjects.begin(), info.first.subjects.end(),
                     [](const Subject& s) { return (s.backward || s.forward) && s.depth; });
}

PlannedPass repair_pass(const SequenceInfo& info, const Parameters& parameters, Plan& plan) {
  const char* const name = "repair motion";
  if (!plan.use_motion) return {name, false, "no vectors"};
  if (parameters.repair.mode == RepairMotion::off)
    return {name, false, "vectors are believed; --repair-motion check or on tests them"};
  if (!has_others(info)) return {name, false, "there is no other frame to test them against"};
  const auto any = [&](bool (*has)(const Subject&)) {
    return std::any_of(info.first.subjects.begin(), info.first.subjects.end(), has);
  };
  const bool ids = any([](const Subject&s) { return s.id.has_value(); }),
             depths = any([](const Subject&s) { return s.depth.has_value(); });
  // The gather tells surfaces apart by what every layer has; one that lacks it would be told apart otherwise.
  if (parameters.accumulator != Accumulator::gather) {
    plan.use_id = plan.use_id || ids;
    plan.use_depth = plan.use_depth || depths;
  }
  const bool cameras = repair_uses_cameras(info);
  plan.use_cameras = plan.use_cameras || cameras;
  return {name, true,
          std::string(parameters.repair.mode == RepairMotion::on ? "vectors that the pixels refute are replaced"
                                                                 : "vectors are tested, none is changed") +
              "; surfaces are told apart by " +
              (ids      ? "their ids"
               : depths ? "depth and by where vectors change"
                        : "where vectors change") +
              (cameras ? "; what the camera makes of resting things is tried first" : "")};
}

std::size_t repair_bytes_per_pixel(const Parameters& parameters) {
  // light of both frames, toned, least and greatest, soft; labels; residual, verdict, how; vectors; the camera's
  return parameters.repair.mode == RepairMotion::off ? 0 : 2 * 4 + 2 * 4 + 2 * 4 + 2 * 4 + 4 + 4 + 1 + 1 + 8 + 8;
}

double repair_nanoseconds(const Parameters& parameters) {
  if (parameters.repair.mode == RepairMotion::off) return 0;
  return parameters.accumulator == Accumulator::recursive || parameters.accumulator == Accumulator::subpixel
             ? 100
             : 200;  // both directions
}

}  // namespace varve
