// The page to read first: probe -> plan -> preflight -> per frame: read, sanitize, motion, accumulate, write, report.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plan/plan.h"

namespace varve {

/// Everything a resolve needs to know; the command line fills it, a program may.
struct ResolveJob {
  InputSequence input;
  SequencePattern output;
  std::optional<SequencePattern> diagnostics;  ///< separate diagnostic files
  std::vector<int> frames;                     ///< frames to write; empty: all on disk
  int preroll = 0;                             ///< frames read before the first one written, to warm the history up
  std::vector<int> cuts;                       ///< first frames of new shots
  RoleRequest roles;
  std::string jitter = "auto";                 ///< see parse_jitter_source
  Parameters parameters;
  OutputRequest request;
  std::optional<Compression> compression;
  int zip_level = 4;
  std::string ocio_config, from_space, to_space;  ///< color conversion around the resolve; empty: none
  std::string preview_folder;                     ///< PNG of color and diagnostics; empty: none
  std::string display, view;                      ///< OpenColorIO display and view of the previews; empty: the config's default
  bool resume = false;
  int threads = 0;                                ///< 0: every processor
};

/// One row per frame.
struct FrameReport {
  int frame = 0;
  std::string path;
  bool written = false, skipped = false;  ///< skipped: complete from an earlier run (--resume); neither: pre-roll
  double read_seconds = 0, resolve_seconds = 0, write_seconds = 0;
  std::size_t pixels = 0, not_finite = 0, vectors_bad = 0, restarted = 0, clipped = 0, half_overflows = 0;
  std::string restart;                    ///< why the history was dropped; empty if it was not
};

struct ResolveSummary {
  int frames_written = 0, frames_skipped = 0;
  bool stopped = false;                   ///< asked to stop between frames
};

/// Calls of the resolver to whoever runs it. All may be empty.
struct ResolveEvents {
  std::function<void(const SequenceInfo&, const Plan&)> planned;
  std::function<void(const FrameReport&, int done, int total)> frame;
  std::function<void(const std::string& sentence)> warning;
  std::function<bool()> should_stop;      ///< looked at between the stages of a frame; no half file remains
};

/// Headers, plan and preflight only (--dry-run, probe). Throws Failure.
Plan plan_sequence(const ResolveJob& job, SequenceInfo& info);

/// Resolves and writes every requested frame. What was written before a Failure stays valid.
ResolveSummary resolve_sequence(const ResolveJob& job, const ResolveEvents& events);

/// Program version, "0.1.0".
const char* version();

}  // namespace varve
