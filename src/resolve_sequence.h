// The page to read first: probe -> plan -> preflight -> per frame: read, sanitize, motion, accumulate, write, report.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "base/reject.h"
#include "base/version.h"
#include "motion/repair_motion.h"
#include "plan/plan.h"
#include "plan/resolve_job.h"
#include "rerender/rerender_list.h"
#include "resolve/light_sum.h"

namespace varve {

/// One row per frame.
struct FrameReport {
  int frame = 0;
  std::string path;
  bool written = false, skipped = false;  ///< skipped: complete from an earlier run (--resume); neither: pre-roll
  double read_seconds = 0, resolve_seconds = 0, write_seconds = 0;
  std::array<std::size_t, kRejectBits> rejected{};  ///< pixels with each bit of the diagnostic plane `reject`
  std::size_t pixels = 0, not_finite = 0, vectors_bad = 0, restarted = 0, clipped = 0, half_overflows = 0;
  std::size_t with_vectors = 0;             ///< pixels of the subjects that have vectors
  std::size_t by_camera = 0;                ///< pixels whose vector is that of a camera
  std::size_t lens_added = 0;               ///< pixels to whose vector zoom or lens shift was added
  MotionCensus vectors;                     ///< of the vectors that were tested (--repair-motion), both directions
  std::array<std::size_t, 5> vectors_by{};  ///< of these, pixels by RepairedBy; under check: what would be done
  std::size_t opacity_held = 0;             ///< pixels of layers whose alpha or transmittance lay beyond 0..1
  std::size_t companions_not_finite = 0;    ///< values of --channels that were NaN or infinite
  std::size_t deep_samples = 0;             ///< of deep parts that were flattened
  std::size_t deep_repaired = 0;            ///< of these left out or put right: no depth, ZBack before Z, bad alpha
  LightSum lights;                          ///< of the colors that have companions; no pixels without
  double removed_light = 0;                 ///< luminance that --firefly-limit held back, summed over the pixels
  int samples = 1;                          ///< of each pixel, under --samples
  std::string restart;                      ///< why the history was dropped; empty if it was not
};

struct ResolveSummary {
  int frames_written = 0, frames_skipped = 0;
  bool stopped = false;                  ///< asked to stop between frames
  std::optional<RerenderList> rerender;  ///< where job.rerender names files for it, and all frames were done
};

/// Calls of the resolver to whoever runs it. All may be empty.
struct ResolveEvents {
  std::function<void(const SequenceInfo&, const Plan&)> planned;
  std::function<void(const FrameReport&, int done, int total)> frame;
  std::function<void(const std::string& sentence)> warning;
  std::function<void(const std::string& sentence)> waiting;  ///< what is waited for, whenever that changes
  /// Preflight is passed: nothing that is written lies over an input. With what the headers will say.
  std::function<void(const std::string& parameters, const std::string& hash)> checked;
  std::function<bool()> should_stop;  ///< looked at between the stages of a frame; no half file remains
};

/// Headers, plan and preflight only (--dry-run, probe). Throws Failure.
Plan plan_sequence(const ResolveJob& job, SequenceInfo& info);

/// Resolves and writes every requested frame. What was written before a Failure stays valid.
ResolveSummary resolve_sequence(const ResolveJob& job, const ResolveEvents& events);

}  // namespace varve
