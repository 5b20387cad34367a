#include "farm_options.h"

#include "option_values.h"

namespace varve::cli {

void add_farm_options(std::vector<Option>& rows) {
  const std::string group = "Input and output";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"preroll", 0, "FRAMES", kResolve, Tier::advanced, group,
       "Frames read before the first one written, so that a chunk of a shot starts with history. 0 starts without. "
       "What "
       "is left of the difference to the whole shot, where history is not rectified: (1 - alpha)^FRAMES of it with "
       "--alpha-rule fixed; with --alpha-rule mean the present counts more than alpha for the first 1/alpha frames, "
       "and "
       "(1 - alpha)^(FRAMES - 1/alpha) of the difference after these is left. --state-in leaves nothing. Accumulators "
       "that look at the frames around each frame need none.",
       number([](auto& s) -> auto& { return s.job.preroll; }, {0, 100000})});
  add({"state-out", 0, "FILE", kResolve, Tier::advanced, group,
       "Write what is known after the last frame: history and vectors of everything that is resolved, in float. It "
       "takes "
       "about 24 bytes for each pixel of each layer, and 16 more for each of --channels. Written when the last frame "
       "is; "
       "--resume takes a whole one from the same frames for done.",
       text(
           [](auto& s) -> auto& { return s.job.state_out; }, "a file name")})
      .completes = Completes::files;
  add({"state-in", 0, "FILE", kResolve, Tier::advanced, group,
       "Go on from what --state-out has written after the frame before the first of --frames: chunks one after the "
       "other "
       "then give the same bytes as one run over all of them. Refused where version, parameters, layers, or frames do "
       "not fit, or where a frame that it was made from was rendered again. Only for accumulators that carry a "
       "history.",
       text(
           [](auto& s) -> auto& { return s.job.state_in; }, "a file that --state-out has written")})
      .completes = Completes::files;
  add({"resume", 0, "", kResolve, Tier::basic, group,
       "Skip frames whose output is complete and was made with the same parameters from the same frames. Frames that "
       "were "
       "rendered again under the same names are noticed by their contents, which are read for that.",
       flag([](auto& s) -> auto& { return s.job.resume; })});
  add({"wait", 0, "SECONDS", kResolve, Tier::advanced, group,
       "Wait for requested frames that are not there yet, or not complete, before the work begins. Gives up with exit "
       "code 3 when nothing has changed for this long. Needs --frames. 0 does not wait.",
       number([](auto& s) -> auto& { return s.job.wait_seconds; }, {0, 1e7})});
}

}  // namespace varve::cli
