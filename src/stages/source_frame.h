// One frame, read: what the accumulators work on.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "plan/resolve_job.h"
#include "stages/read_present.h"

namespace varve {

/// One frame as the accumulators see it.
struct SourceFrame {
  FrameHeaders headers;
  FileSet pixels;                 ///< as stored; empty where the frame is read again when it is written
  std::vector<Present> presents;  ///< one for each of accumulated_subjects(): a subject, or several combined
  std::size_t vectors_bad = 0;    ///< vectors that cannot be used
};

/// Names the frame in what a stage has to say: file names alone need not tell it.
template <typename Work>
auto in_frame(int frame, Work work) {
  try {
    return work();
  } catch (const Failure& failure) {
    throw Failure(failure.code(), "frame " + std::to_string(frame) + ": " + failure.what());
  }
}

/// What every frame of a job is read by.
struct SourceOptions {
  const ResolveJob& job;
  const SequenceInfo& info;
  const Plan& plan;
  const JitterSource& jitter;
  const ColorConversion* into_working_space = nullptr;
  bool keep_pixels = false;    ///< SourceFrame::pixels stay, with all that is only passed through
  bool show_combined = false;  ///< Present::combined is asked for
};

/// Reads one frame: headers, the channels that the plan names, a present for each thing that is
/// accumulated, vectors as stored. Throws
/// Failure naming the frame.
SourceFrame read_source_frame(const SourceOptions& options, int frame, Workers& workers);

}  // namespace varve
