#include "stages/cameras_around.h"

#include "motion/camera_vectors.h"
#include "plan/camera_survey.h"

namespace varve {

std::optional<CameraChange> camera_change(const FrameCameras& here, const FrameCameras& there, std::size_t subject) {
  if (subject >= there.cameras.size() || !here.cameras[subject] || !there.cameras[subject]) return std::nullopt;
  Camera from = *here.cameras[subject], to = *there.cameras[subject];
  take_out_jitter(from, to, here.jitter[subject], there.jitter[subject]);
  return change_between(from, to);
}

std::vector<CamerasAround> cameras_around(const FrameHeaders& headers, const NeighborFrames& neighbors,
                                          const ResolveJob& job, const JitterSource& jitter, const CameraSource& source,
                                          CameraTrack& track) {
  const auto find = [&](const std::optional<int>& frame) -> const FrameCameras* {
    if (!frame) return nullptr;
    if (!track.contains(*frame))
      track.emplace(*frame, kept_cameras(read_frame_headers(job.input, *frame, job.roles, jitter, source)));
    return &track.at(*frame);
  };
  const FrameCameras here = kept_cameras(headers);
  const FrameCameras *before = find(neighbors.before), *after = find(neighbors.after);
  const auto change_to = [&](const FrameCameras* there, std::size_t k) {
    return there ? camera_change(here, *there, k) : std::nullopt;
  };
  std::vector<CamerasAround> around;
  for (std::size_t k = 0; k < here.cameras.size(); ++k)
    around.push_back({here.cameras[k], change_to(before, k), change_to(after, k)});
  return around;
}

}  // namespace varve
