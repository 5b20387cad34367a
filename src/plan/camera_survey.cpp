#include "plan/camera_survey.h"

#include <utility>

namespace varve {

std::vector<FoundCamera> cameras_of(const FrameHeaders& headers, const CameraSource& source) {
  std::vector<FoundCamera> cameras;
  const std::vector<Part>& parts = headers.files.front().parts;
  for (const Subject& subject : headers.subjects) {
    const Part& part = parts[std::size_t(part_of(subject))];
    // The attributes of a part with several views are those of the default view.
    const bool other_view = part.view.empty() && !subject.view.empty() && !subject.default_view;
    if (other_view) {
      cameras.emplace_back();
      continue;
    }
    FoundCamera found = find_camera(source, part, headers.frame);
    if (found.source.empty() && parts.front().view == part.view)
      found = find_camera(source, parts.front(), headers.frame);
    cameras.push_back(std::move(found));
  }
  return cameras;
}

FrameCameras kept_cameras(const FrameHeaders& headers) {
  FrameCameras kept;
  for (std::size_t k = 0; k < headers.cameras.size(); ++k) {
    kept.cameras.push_back(headers.cameras[k].camera);
    const std::optional<Jitter> jitter = jitter_of_subject(headers, k);
    kept.jitter.push_back(jitter ? std::optional(glm::dvec2(jitter->x, jitter->y)) : std::nullopt);
  }
  return kept;
}

void CameraSurvey::add(const FrameHeaders& headers) {
  const FoundCamera& main = headers.cameras.front();
  frames += main.camera.has_value();
  unusable += !main.camera && !main.source.empty();
  if (source.empty()) source = main.source;
  if (!main.problem.empty() && ++problems == 1) {
    problem = main.problem;
    first_problem = headers.frame;
  }
  track.emplace(headers.frame, kept_cameras(headers));
}

void CameraSurvey::finish(SequenceInfo& info) {
  info.frames_with_camera = frames;
  if (frames > 0) info.cameras = std::move(track);
  const std::string of = " of " + std::to_string(info.frames.size()) + " frames";
  info.camera = source.empty() ? "none found" : source + " in " + std::to_string(frames + unusable) + of;
  if (unusable > 0)
    info.notes.push_back("the camera of " + std::to_string(unusable) + of + " is not used: in frame " +
                         std::to_string(first_problem) + " " + problem +
                         "; give cameras with --camera FILE, or --camera off");
  else if (problems > 0)
    info.notes.push_back("cameras: " + problem);
  for (const auto& [frame, row] : info.cameras)
    if (row.cameras.front()) {
      if (row.cameras.front()->projection == Projection::orthographic) info.camera += ", orthographic";
      break;
    }
}

}  // namespace varve
