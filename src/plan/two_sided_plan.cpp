#include "plan/two_sided_plan.h"

#include <algorithm>

#include "plan/value.h"

namespace varve {

PlannedPass motion_of_both_sides(bool moves, bool inverted, bool with_depth, bool tested, const std::string& share) {
  if (!moves) return {"motion ahead", false, "no vectors"};
  if (!inverted)
    return {"motion ahead", true,
            std::string("the files have vectors to the frame before and to the frame after") +
                (tested ? "; those that do not lead back are dropped" : "")};
  return {"motion ahead", true,
          "vectors of one direction are missing: those of the neighboring frame are inverted" + share +
              (with_depth ? "; the nearest depth wins, and what is hidden there restarts"
                          : "; without depth what is hidden there is known only where nothing else arrives")};
}

PlannedPass past_and_future(const Parameters& parameters, const OutputRequest& output) {
  const std::string frames = std::to_string(look_ahead_frames(parameters.two_sided, parameters.recursive.alpha));
  return {"past and future", true,
          "each frame is made of at least " + frames +
              " frames before and after it, where there are so many, in blocks of " + frames +
              " counted from frame 0; every frame is read three times, and the future of a block waits " +
              (output.spill_folder.empty() ? "in memory" : "in a file")};
}

std::string blend_of_both_sides(const Parameters& parameters) {
  const std::string alpha = number_text(parameters.recursive.alpha);
  std::string text = "past, present and future by their weights, the present counted once; ";
  text += parameters.recursive.alpha_rule == AlphaRule::fixed
              ? "a frame at distance k weighs (1 - " + alpha + ")^k"
              : "frames weigh the same until a side has the weight that alpha " + alpha + " leaves to it";
  if (parameters.rectify.clip_discount && parameters.rectify.box != Box::none)
    text += "; a side that was clipped weighs less";
  return text;
}

std::size_t waiting_bytes_per_pixel(const Parameters& parameters, const OutputRequest& output) {
  if (parameters.accumulator != Accumulator::two_sided || !output.spill_folder.empty()) return 0;
  const auto planned = planned_aovs(output, parameters.accumulator);
  const auto asks = [&](std::string_view name) {
    return std::any_of(planned.begin(), planned.end(), [&](const Aov* aov) { return aov->name == name; });
  };
  const std::size_t bytes =
      16 + 4 + 4 + (asks("clip") ? 4 : 0) + (asks("reject") || asks("reject-future") || asks("evaluation") ? 4 : 0);
  return bytes * std::size_t(look_ahead_frames(parameters.two_sided, parameters.recursive.alpha));
}

}  // namespace varve
