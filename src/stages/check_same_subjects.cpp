#include "stages/check_same_subjects.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace varve {

void check_same_subjects(const FrameHeaders& first, const FrameHeaders& now, const Plan& plan) {
  const std::string where = "frame " + std::to_string(now.frame) + " ('" + now.files.front().path + "')";
  if (now.subjects.size() != first.subjects.size())
    throw Failure(ExitCode::inconsistent, where + " has " + std::to_string(now.subjects.size()) +
                                              " color layers to resolve, frame " + std::to_string(first.frame) +
                                              " has " + std::to_string(first.subjects.size()) +
                                              "; render it again, or leave it out with --frames");
  for (std::size_t i = 0; i < now.subjects.size(); ++i) {
    const Subject &a = first.subjects[i], &b = now.subjects[i];
    const std::string layer = b.layer.empty() ? "the main layer" : "layer '" + b.layer + "'";
    if (a.layer != b.layer || a.view != b.view)
      throw Failure(ExitCode::inconsistent, where + " has " + layer + " where frame " + std::to_string(first.frame) +
                                                " has '" + a.layer +
                                                "'; choose with --layer, or leave the frame out with --frames");
    for (std::size_t k = 0; k < 4; ++k)
      if (a.color[k].has_value() != b.color[k].has_value())
        throw Failure(ExitCode::inconsistent, where + ", " + layer + ": channel " + "RGBA"[k] + " is " +
                                                  (b.color[k] ? "there" : "missing") + " but not so in frame " +
                                                  std::to_string(first.frame) +
                                                  "; render it again, or leave it out with --frames");
    const auto same_places = [](const Companion& c, const Companion& d) {
      for (std::size_t k = 0; k < 4; ++k)
        if (c.channels[k].has_value() != d.channels[k].has_value()) return false;
      return c.layer == d.layer && c.color == d.color;
    };
    if (!std::equal(a.companions.begin(), a.companions.end(), b.companions.begin(), b.companions.end(), same_places))
      throw Failure(ExitCode::inconsistent,
                    where + ", " + layer + ": what --channels names is not what it is in frame " +
                        std::to_string(first.frame) +
                        "; render it again, name other channels, or leave it out with --frames");
    const bool other_vectors =
        a.backward.has_value() != b.backward.has_value() || a.forward.has_value() != b.forward.has_value();
    const bool other_marks = (plan.use_id && a.id.has_value() != b.id.has_value()) ||
                             (plan.use_normal && a.normal.has_value() != b.normal.has_value());
    if ((plan.use_motion && other_vectors) || (plan.use_depth && a.depth.has_value() != b.depth.has_value()) ||
        other_marks)
      throw Failure(ExitCode::inconsistent,
                    where + ", " + layer + ": its depth, motion, id or normal channels are not those of frame " +
                        std::to_string(first.frame) + "; render it again, or leave it out with --frames");
  }
}

}  // namespace varve
