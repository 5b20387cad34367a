// The cameras of a sequence: found frame by frame, then told.
#pragma once

#include <string>
#include <vector>

#include "plan/probe.h"

namespace varve {

/// The camera of each subject of a frame: what its part says, else what the first part says, if that is of the same
/// view. Throws what find_camera throws.
std::vector<FoundCamera> cameras_of(const FrameHeaders& headers, const CameraSource& source);

/// What of that is kept when the headers are gone.
FrameCameras kept_cameras(const FrameHeaders& headers);

/// Goes through the frames in ascending order.
struct CameraSurvey {
  std::string source;   ///< of the first camera
  std::string problem;  ///< first one told
  int first_problem = 0, problems = 0, unusable = 0;
  int frames = 0;  ///< whose first subject has a camera
  CameraTrack track;

  void add(const FrameHeaders& headers);
  /// Fills in camera, frames_with_camera and cameras, and adds notes.
  void finish(SequenceInfo& info);
};

}  // namespace varve
