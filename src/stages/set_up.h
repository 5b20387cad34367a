// What is decided before any frame is resolved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exr/color_space.h"
#include "plan/plan.h"
#include "stages/preflight.h"
#include "stages/settle_layers.h"
#include "stages/state_file.h"

namespace varve {

/// Made once, used for every frame.
struct Setup {
  const ResolveJob& job;
  SequenceInfo info;
  Plan plan;
  JitterSource jitter;
  CameraSource cameras;
  std::string parameters, hash;
  FrameReach reach;
  GatherParameters gather;
  std::vector<const Aov*> aovs;      ///< asked for
  std::vector<const Aov*> measured;  ///< these, and what a list of renders is made from
  ExtraSamples extras;
  std::optional<ColorConversion> into_working_space, out_of_working_space;
  std::optional<DisplayTransform> display;
  std::optional<StateHead> before;  ///< of --state-in
};

/// Headers, plan and color transforms; pixels only where the jitter is measured in them. `ordered` must outlive the
/// result. Throws Failure where the job cannot be done.
Setup set_up(const SettledLayers& ordered);

}  // namespace varve
