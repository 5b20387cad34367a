#include "synth_options.h"

#include "option_values.h"

namespace varve::cli {
namespace {

constexpr Word<PixelType> kColorTypes[] = {
    {"half", PixelType::float16, "16 bits; 65504 at most"},
    {"float", PixelType::float32, "32 bits"},
};
constexpr Word<std::optional<synth::Filter>> kFilters[] = {
    {"none", std::nullopt, "no truth is written"},
    {"box", synth::Filter::box, "one pixel"},
    {"gaussian", synth::Filter::gaussian, "sigma 0.5 pixels, cut at 1.5"},
    {"blackman-harris", synth::Filter::blackman_harris, "four terms over 3 pixels, the default of Cycles"},
};
constexpr Word<SynthCameras> kCameras[] = {
    {"attributes", SynthCameras::attributes, "the standard attributes worldToCamera and worldToNDC"},
    {"note", SynthCameras::note, "view and proj in JSON in the attribute Note"},
    {"both", SynthCameras::both, "both"},
    {"none", SynthCameras::none, "nowhere"},
};
constexpr auto kBasic = Tier::basic, kAdvanced = Tier::advanced;

}  // namespace

void add_synth_options(std::vector<Option>& rows) {
  const auto add = [&rows](const char* group, Option option) -> Option& {
    option.commands = kSynth;
    option.group = group;
    return rows.emplace_back(std::move(option));
  };
  const char* const files = "Input and output";
  add(files, {"output", 'o', "DIR", 0, kBasic, "", "Folder to write to; made when it is not there. Required.",
              text(
                  [](auto& s) -> auto& { return s.synth.folder; }, "a folder")})
      .completes = Completes::folders;
  add(files, {"frames", 'f', "LIST", 0, kBasic, "", "Frames to render; without it all frames of the scene, 1-48.",
              frames([](auto& s) -> auto& { return s.synth.frames; })});
  add(files, {"size", 0, "WxH", 0, kBasic, "", "Pixels of the picture; without it 320x180.",
              size_value([](Settings& s, int width, int height) { s.synth.width = width, s.synth.height = height; })});
  add(files, {"type", 0, "TYPE", 0, kAdvanced, "", "Pixel type of color and alpha of the samples; all else is float.",
              word(
                  [](auto& s) -> auto& { return s.synth.type; }, kColorTypes)});
  const char* const samples = "Samples";
  add(samples, {"samples", 0, "COUNT", 0, kBasic, "",
                "Samples in each pixel, kept apart: parts sample.0, sample.1, and so on with jitters of their own.",
                number([](auto& s) -> auto& { return s.synth.samples; }, {1, 64})});
  add(samples, {"layers", 0, "", 0, kBasic, "",
                "Write the layers fg, mid, and bg with their own depth and motion beside the composite.",
                flag([](auto& s) -> auto& { return s.synth.layers; })});
  add(samples,
      {"jitter", 0, "SOURCE", 0, kAdvanced, "",
       "Where in its pixel each frame is sampled. The length of a pattern counts frames; see `varve help patterns`. A "
       "CSV file has the "
       "columns frame,jx,jy, sample position minus pixel center in pixels, y down.",
       text(
           [](auto& s) -> auto& { return s.synth.jitter; }, "none, a CSV file or a pattern such as halton23:16")})
      .completes = Completes::files;
  add(samples,
      {"noise", 0, "SIGMA", 0, kBasic, "",
       "Relative noise of every sample, as path tracing has it: the color is multiplied with a random factor of "
       "this deviation and of mean 1. Truth and yardsticks have none.",
       number([](auto& s) -> auto& { return s.synth.noise; }, {0, 100})});
  add(samples, {"seed", 0, "NUMBER", 0, kAdvanced, "", "Of noise, chance, and the places of the samples of truth.",
                number([](auto& s) -> auto& { return s.synth.seed; }, {0, 2147483647})});
  add(samples, {"cameras", 0, "WHERE", 0, kAdvanced, "", "Where the camera of each frame is written.",
                word(
                    [](auto& s) -> auto& { return s.synth.cameras; }, kCameras)});
  const char* const truth = "Truth";
  add(truth, {"truth", 0, "FILTER", 0, kBasic, "", "Write the truth, seen through this pixel filter, to DIR/truth.",
              word(
                  [](auto& s) -> auto& { return s.synth.truth; }, kFilters)});
  add(truth, {"truth-samples", 0, "COUNT", 0, kBasic, "",
              "Samples in each pixel of the truth, stratified; rounded up to a square.",
              number([](auto& s) -> auto& { return s.synth.truth_samples; }, {1, 65536})});
  add(truth, {"yardsticks", 0, "LIST", 0, kBasic, "",
              "Write renders with n x n stratified samples and a box filter to DIR/ssN, for each n of the list.",
              yardsticks_value()});
}

}  // namespace varve::cli
