#include "rerender_options.h"

#include "option_values.h"

namespace varve::cli {
namespace {

/// The file's name says what it is.
Value<Settings> list_file() {
  return {[](Settings& s, std::string_view text) {
            if (!text.ends_with(".json") && !text.ends_with(".csv")) return false;
            s.job.rerender.files.emplace_back(text);
            return true;
          },
          nullptr,
          "a file name that ends in .json or .csv",
          {}};
}

Value<Settings> extra_files() {
  return {[](Settings& s, std::string_view text) {
            s.job.extra.emplace_back(text);
            return !text.empty();
          },
          nullptr,
          "a file name such as extra.*.####.exr",
          {}};
}

}  // namespace

void add_rerender_options(std::vector<Option>& rows) {
  const std::string group = "Further samples";
  const auto add = [&](const char* name, const char* metavar, Tier tier, const char* help,
                       Value<Settings> value) -> Option& {
    return rows.emplace_back(Option{name, 0, metavar, kResolve, tier, group, help, std::move(value)});
  };
  add("want-samples", "COUNT", Tier::advanced,
      "Effective samples that a pixel is to have, for --aov evaluation and --rerender; where history was turned down "
      "and only its own sample is left it lacks all of them. 0: any number will do.",
      number([](auto& s) -> auto& { return s.job.rerender.want_samples; }, {0, 4096}));
  add("want-noise", "RATIO", Tier::advanced,
      "Likewise the noise that a pixel may have: its standard deviation over the light around it. 0: any will do.",
      number([](auto& s) -> auto& { return s.job.rerender.want_noise; }, {0, 1000}));
  Option& list =
      add("rerender", "FILE", Tier::basic,
          "Write a list of what to render again when all frames are done: frames, windows of pixels in the "
          "forms that renderers know, and where in its pixel each sample is to lie. JSON or CSV, by the name; "
          "both are described by `varve help rerender`. --extra takes back what was rendered.",
          list_file());
  list.repeats = true;
  list.completes = Completes::files;
  add("rerender-budget", "SAMPLES", Tier::advanced,
      "Samples that the list may ask for, for each pixel of the frames written, on average: tiles that gain most for a "
      "sample come first. 0: all that are lacking.",
      number([](auto& s) -> auto& { return s.job.rerender.budget; }, {0, 4096}));
  add("rerender-most", "SAMPLES", Tier::expert, "Samples that a tile may get in one frame.",
      number([](auto& s) -> auto& { return s.job.rerender.most; }, {1, 4096}));
  add("tile", "PIXELS", Tier::advanced, "Edge of the tiles that samples are shared among.",
      number([](auto& s) -> auto& { return s.job.rerender.tile; }, {4, 4096}));
  add("rerender-overhead", "SAMPLES", Tier::expert,
      "What starting one more render costs: tiles are merged to rectangles where that renders fewer samples in "
      "addition. 0 merges only what is alike.",
      number([](auto& s) -> auto& { return s.job.rerender.overhead; }, {0, 100000000}));
  Option& extra = add("extra", "PATTERN", Tier::basic,
                      "Files with further samples of the frames, whole or crops of them; * in the name stands for "
                      "anything, so that each sample and each crop may be a file of its own. Each says by its data "
                      "window which pixels it has, and by its jitter where they lie.",
                      extra_files());
  extra.repeats = true;
  extra.completes = Completes::files;
  Option& extra_list = add("extra-list", "FILE", Tier::advanced,
                           "The list (JSON) that the files of --extra were rendered by, where they do not tell window "
                           "and jitter themselves.",
                           text(
                               [](auto& s) -> auto& { return s.job.extra_list; }, "a JSON file of --rerender"));
  extra_list.completes = Completes::files;
}

}  // namespace varve::cli
