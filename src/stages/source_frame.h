// One frame, read: what the accumulators work on.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "motion/repair_motion.h"
#include "plan/extra_samples.h"
#include "plan/resolve_job.h"
#include "stages/cameras_around.h"
#include "stages/move_by_camera.h"
#include "stages/read_present.h"

namespace varve {

/// One frame as the accumulators see it.
struct SourceFrame {
  FrameHeaders headers;
  FileSet pixels;                            ///< as stored; empty where the frame is read again when it is written
  std::vector<Present> presents;             ///< one for each of accumulated_subjects(): a subject, or several combined
  std::vector<CamerasAround> cameras;        ///< one for each of headers.subjects; empty without
  std::vector<std::vector<Present>> extras;  ///< for each of headers.outputs further samples that are not in presents,
                                             ///< with a window of their own, valid in some pixels only; of the gather
  CameraVectors by_camera;
  std::size_t vectors_bad = 0;        ///< vectors that cannot be used
  DeepCounts deep;                    ///< samples of deep parts that were flattened
  std::vector<MotionRepair> repairs;  ///< of the vectors to the frame before, one for each present where they were
                                      ///< tested; filled by the accumulators
  std::vector<MotionRepair> forward_repairs;  ///< likewise of those to the frame after, where they are followed;
                                              ///< counts only
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

/// The cameras of one of source.presents: those of its subject, or of the first of several that were combined; none
/// where they are not used.
CamerasAround cameras_of(const SourceFrame& source, std::size_t present);
/// The same of other cameras than source.cameras, one for each of headers.subjects.
CamerasAround cameras_of(const FrameHeaders& headers, const std::vector<CamerasAround>& cameras, std::size_t present);

/// What every frame of a job is read by.
struct SourceOptions {
  const ResolveJob& job;
  const SequenceInfo& info;
  const Plan& plan;
  const JitterSource& jitter;
  const CameraSource& cameras;
  CameraTrack& camera_track;  ///< grows by frames that were not probed
  const ExtraSamples& extras;
  const ColorConversion* into_working_space = nullptr;
  bool keep_pixels = false;    ///< SourceFrame::pixels stay, with all that is only passed through
  bool show_combined = false;  ///< Present::combined is asked for
};

/// Reads one frame: headers, the channels that the plan names, a present for each thing that is accumulated, vectors as
/// stored but for what cameras add. `neighbors` are the frames that its vectors lead to. Throws Failure naming the
/// frame.
SourceFrame read_source_frame(const SourceOptions& options, int frame, const NeighborFrames& neighbors,
                              Workers& workers);

}  // namespace varve
