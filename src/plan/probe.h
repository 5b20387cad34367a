// What is in a sequence, from headers only.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "exr/camera_source.h"
#include "exr/channel_names.h"
#include "exr/jitter.h"
#include "exr/sequence.h"

namespace varve {

/// Where the pixels come from: the color sequence and, where roles live in files of their own, those.
struct InputSequence {
  SequencePattern color;
  std::vector<SequencePattern> roles;  ///< depth, motion, ... read beside the color, same frame numbers
};

/// One frame as its headers show it.
struct FrameHeaders {
  int frame = 0;
  std::vector<FileHeader> files;  ///< color file, then the role files
  std::vector<Subject> subjects;  ///< found again in each frame, since parts and channels may move
  std::vector<ColorOutput> outputs;
  std::optional<Jitter> jitter;                      ///< of samples, the mean of theirs, if each is known
  std::vector<std::optional<Jitter>> sample_jitter;  ///< of each subject where they are samples; else empty
  PassedOn passed_on;
  int grid = 1;                      ///< files are shown as if each n x n pixels were n x n parts
  std::vector<FileHeader> stored;    ///< as they are on disk, where `grid` is not 1
  std::vector<FoundCamera> cameras;  ///< one for each of subjects
};

/// Where in its pixel a subject was sampled.
inline std::optional<Jitter> jitter_of_subject(const FrameHeaders& headers, std::size_t subject) {
  return headers.sample_jitter.empty() ? headers.jitter : headers.sample_jitter[subject];
}

/// The headers as they are on disk.
inline const std::vector<FileHeader>& files_on_disk(const FrameHeaders& headers) {
  return headers.stored.empty() ? headers.files : headers.stored;
}

/// Reads and checks the headers of one frame. Throws Failure(input) naming file and frame, or what find_subjects
/// throws.
FrameHeaders read_frame_headers(const InputSequence& input, int frame, const RoleRequest& roles,
                                const JitterSource& jitter, const CameraSource& cameras = {});

/// A sequence at a glance.
struct SequenceInfo {
  std::vector<int> frames;      ///< on disk (or asked for), ascending
  std::vector<int> gaps;        ///< missing between first and last
  bool frames_beside = false;   ///< others than those asked for are made use of: set by who knows
  FrameHeaders first;           ///< the frame the plan is made from
  bool windows_move = false;    ///< a data window differs between frames
  bool windows_differ = false;  ///< display windows differ between frames
  int frames_with_jitter = 0;
  std::vector<Jitter> jitters;  ///< known ones of all frames and samples, in their order
  std::string jitter_source;    ///< "none found", or where from
  std::string camera;           ///< "none found", or which attributes, and in how many frames
  int frames_with_camera = 0;
  CameraTrack cameras;             ///< by frame
  std::vector<std::string> notes;  ///< channels that differ between frames, a jitter.csv beside the frames, ...
};

/// Whether there is a frame besides, so that there may be a history.
inline bool has_others(const SequenceInfo& info) { return info.frames.size() > 1 || info.frames_beside; }

/// Reads every header of the chosen frames (empty: all on disk). Throws Failure(input) when a file is missing or
/// broken.
SequenceInfo probe_sequence(const InputSequence& input, const std::vector<int>& frames, const RoleRequest& roles,
                            const JitterSource& jitter, const CameraSource& cameras = {});

/// The numbers of a few frames, for `probe --pixels`: ranges and bad values of each channel that has a role; of a deep
/// part those of its samples, and a row that tells how many a pixel has.
struct ChannelStatistics {
  int frame = 0;
  std::string part, channel, role;
  double least = 0, greatest = 0, mean = 0;  ///< over the finite pixels
  std::size_t pixels = 0, not_finite = 0, zero = 0;
};
std::vector<ChannelStatistics> measure_pixels(const SequenceInfo& info, const InputSequence& input,
                                              const RoleRequest& roles, const JitterSource& jitter, int frames,
                                              Workers& workers);

}  // namespace varve
