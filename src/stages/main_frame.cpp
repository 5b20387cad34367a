#include "stages/main_frame.h"

#include <limits>

#include "stages/read_present.h"
#include "stages/source_frame.h"

namespace varve {

MainFrame read_main_frame(const InputSequence& input, int frame, const RoleRequest& roles, const JitterSource& jitter,
                          const MotionParameters& motion, Workers& workers) {
  RoleRequest main = roles;
  main.channels.clear();
  if (main.layers.size() > 1 || main.layers == std::vector<std::string>{"all"}) main.layers.clear();
  FrameHeaders headers = read_frame_headers(input, frame, main, jitter);
  headers.subjects.resize(1);
  Subject& subject = headers.subjects.front();
  subject.companions.clear();
  DeepFrame untold;
  const FileSet pixels = in_frame(frame, [&] { return read_files(headers, {.motion = true}, untold, workers); });
  const Part& part = headers.files.front().parts[std::size_t(part_of(subject))];
  ReadOptions options;
  options.motion = motion;
  options.use_motion = true;
  std::size_t unusable = 0;
  MainFrame read;
  read.frame = frame;
  read.present =
      read_present(subject, pixels, part.data_window, part.display_window, options, nullptr, unusable, workers);
  if (headers.jitter) read.jitter = glm::dvec2(headers.jitter->x, headers.jitter->y);
  if (const Attribute* camera = part.attribute("worldToCamera"); camera && camera->numbers.size() == 16)
    read.world_to_camera = camera->numbers;
  return read;
}

Plane<glm::vec2> motion_to_previous(const MainFrame& now, const MainFrame* before) {
  if (!now.present.motion.empty()) return now.present.motion.clone();
  if (!before || before->present.forward.empty()) return {};
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  return invert_motion(before->present.forward, {}, {}, 0,
                       Plane<glm::vec2>(now.present.color.window(), 0, glm::vec2(unknown)));
}

}  // namespace varve
