// The camera of a frame, and how it changes to the frames beside it.
#pragma once

#include <optional>
#include <vector>

#include "plan/resolve_job.h"

namespace varve {

/// The frames that vectors lead to; none at the ends of a shot.
struct NeighborFrames {
  std::optional<int> before, after;
};

/// Of one subject. Without the jitter, where the matrices held it.
struct CamerasAround {
  std::optional<Camera> here;
  std::optional<CameraChange> before, after;
};

/// How the camera of a subject of `here` becomes that of `there`, without the jitter; none where one is not known.
std::optional<CameraChange> camera_change(const FrameCameras& here, const FrameCameras& there, std::size_t subject);

/// One for each subject of the frame. `track` has the cameras that are known already and gets those of frames whose
/// headers have to be read for it. Throws what read_frame_headers throws.
std::vector<CamerasAround> cameras_around(const FrameHeaders& headers, const NeighborFrames& neighbors,
                                          const ResolveJob& job, const JitterSource& jitter, const CameraSource& source,
                                          CameraTrack& track);

}  // namespace varve
