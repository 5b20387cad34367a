// What this scene needs: passes with a reason each, channels to read, memory and time.
#pragma once

#include <string>
#include <vector>

#include "diagnose/aov.h"
#include "plan/parameters.h"
#include "plan/probe.h"

namespace varve {

/// A pass that runs, or the reason why it does not.
struct PlannedPass {
  std::string name;  ///< sanitize, motion, dilate, reproject, rectify, sample weights, ...
  bool runs = false;
  std::string reason;  ///< one sentence
};

/// What is to be written.
struct OutputRequest {
  std::vector<std::string> aovs;   ///< names of the diagnostic table; {"all"}
  bool diagnostics_apart = false;  ///< in files of their own
  bool keep_channels = true;       ///< pass the other channels and parts through
  std::string spill_folder;        ///< where two-sided keeps the future of a block; empty: in memory
};

/// The diagnostic planes that are asked for; "all" means those that the accumulator can fill. Throws Failure(usage) for
/// one that does not exist or that it cannot.
std::vector<const Aov*> planned_aovs(const OutputRequest& request, Accumulator accumulator);

struct Plan {
  std::vector<PlannedPass> passes;
  std::vector<ChannelRef> channels;  ///< with a role, read for every frame (positions in the first frame's files);
                                     ///< channels that are only passed through are not among them
  bool use_depth = false;            ///< depth is read and used
  bool use_motion = false;
  bool use_forward = false;  ///< vectors to the next frame are read where the files have them
  bool use_jitter = false;
  bool use_cameras = false;  ///< cameras make or complete vectors, or make depth planar
  bool use_id = false, use_normal = false, use_reactive = false, use_responsive = false;  ///< read and used
  std::size_t bytes = 0;                                                                  ///< peak memory expected
  double seconds_per_frame = 0;                                                           ///< expected wall time
  std::vector<std::string> notes;  ///< assumptions and warnings, a sentence each
};

/// Throws Failure(inconsistent) when what is asked for cannot be done with what is there (naming the remedy).
Plan make_plan(const SequenceInfo& info, const Parameters& parameters, const OutputRequest& output, int threads);

}  // namespace varve
