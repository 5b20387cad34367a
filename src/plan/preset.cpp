#include "plan/preset.h"

#include <algorithm>

#include "base/error.h"
#include "plan/knob.h"

namespace varve {
namespace {

constexpr Preset kPresets[] = {
    {"draft", "Varve",
     "Three frames on each side, four cells in a pixel, light as it is: a first look. On the scenes quality-* it gains "
     "13.7 dB over the input at rest, 10.5 with a moving camera, 12.8 with moving objects, and takes 2 microseconds a "
     "pixel and frame on one core.",
     "accumulator=gather camera-motion=all reach=3 cells=2 sigma=0.2 gain=off change-limit=0 firefly-limit=0 "
     "sample-filter=none "
     "return-tolerance=0"},
    {"standard", "Varve",
     "Eight frames on each side, sixteen cells, light that changes is followed. Gains 19.4, 14.4 and 16.8 dB; 7 "
     "microseconds.",
     "accumulator=gather camera-motion=all reach=8 cells=4 sigma=0.12 gain=on gain-window=21 change-limit=2.5 "
     "firefly-limit=0 "
     "sample-filter=none return-tolerance=0"},
    {"high", "Varve", "Sixteen frames on each side: for final frames. Gains 20.2, 15.9 and 17.3 dB; 12 microseconds.",
     "accumulator=gather camera-motion=all reach=16 cells=4 sigma=0.1 gain=on gain-window=21 change-limit=2.5 "
     "firefly-limit=0 "
     "sample-filter=none return-tolerance=0.5"},
    {"reference", "Varve",
     "Twenty-four frames on each side, thirty-six cells: as good as it gets. Gains 20.4, 16.4 and 17.4 dB; 16 "
     "microseconds.",
     "accumulator=gather camera-motion=all reach=24 cells=6 sigma=0.07 gain=on gain-window=21 change-limit=2.5 "
     "firefly-limit=0 "
     "sample-filter=none return-tolerance=0.5"},
    {"two-sided", "Fraser and Potter 1969; Rauch, Tung and Striebel 1965",
     "Past and future histories merged: for frames without ids, depth or jitter that the gather could use, or with "
     "vectors that are wrong. Gains 8.4, 5.8 and 7.7 dB; 0.6 microseconds.",
     "accumulator=two-sided camera-motion=all dilation=longest alpha=0.1 alpha-rule=fixed history-filter=catmull-rom "
     "dering=on "
     "disocclusion=window sample-filter=none look-ahead=8 return-tolerance=0.5 "
     "box=variance gamma=1 window=3 moments=direct rule=clip anchor=present space=rgb hull-passes=64 "
     "clip-discount=on"},
    {"salvi", "Salvi 2016, An Excursion in Temporal Supersampling",
     "Variance clipping: sharp history along the longest vector, held to the noise of the present.",
     "accumulator=recursive dilation=longest alpha=0.1 alpha-rule=mean history-filter=catmull-rom dering=on "
     "disocclusion=window "
     "sample-filter=none look-ahead=0 return-tolerance=0.5 "
     "box=variance gamma=1 window=3 moments=direct rule=clip anchor=present space=rgb hull-passes=64 "
     "clip-discount=off"},
    {"yang", "Yang, Nehab, Sander, Sitthi-amorn, Lawrence and Hoppe 2009, Amortized Supersampling",
     "Four sub-pixel histories, blur and lag bounded, nothing but depth to drop history; needs jitter and depth. Where "
     "there "
     "are ids, --id-test hard keeps things that touch from leaving trails.",
     "accumulator=subpixel dilation=none alpha=0.15 alpha-rule=mean disocclusion=depth sample-filter=none "
     "blur-limit=0.3 residual-limit=0.3 residual-window=7 subpixel-radius=0.5 subpixel-weights=second-order "
     "blur-bound=tracked box=none moments=direct hull-passes=64 clip-discount=off"},
    {"lopez", "Lopez, The Holy Trail; defaults of the public code MSAAFilter",
     "A tenth of the present, the vector of the nearest surface, sharp history, a wide variance box around the mean.",
     "accumulator=recursive dilation=nearest alpha=0.1 alpha-rule=fixed history-filter=catmull-rom dering=on "
     "disocclusion=window sample-filter=none "
     "box=variance gamma=1.5 window=3 moments=direct rule=clip anchor=center space=rgb hull-passes=64 "
     "clip-discount=off weighing=luminance"},
    {"crytek2", "Sousa 2011 (Crysis 2); Wronski 2014",
     "Two jittered frames in equal parts, neighbors have no say; render with the jitter pattern two-frame.",
     "accumulator=recursive dilation=none alpha=0.5 alpha-rule=fixed history-filter=bilinear disocclusion=window "
     "sample-filter=none box=none moments=direct hull-passes=64 clip-discount=off speed-difference=1 "
     "on-reject=restart"},
    {"inside", "Pedersen 2016 (INSIDE); its public code",
     "Present fetched at minus the jitter, history clipped to the center of the rounded box; needs the jitter.",
     "accumulator=recursive dilation=nearest alpha=0.05 alpha-rule=fixed history-filter=bilinear disocclusion=window "
     "unjitter=bilinear sample-filter=none "
     "box=rounded window=3 moments=direct rule=clip anchor=center space=rgb hull-passes=64 clip-discount=off "
     "feedback=luma feedback-low=0.88 feedback-high=0.97 motion-blur=own motion-blur-from=2 motion-blur-to=15"},
};

}  // namespace

std::span<const Preset> presets() { return kPresets; }

const Preset* find_preset(std::string_view name) {
  for (const Preset& preset : kPresets)
    if (preset.name == name) return &preset;
  return nullptr;
}

Parameters preset_parameters(const Preset& preset) {
  Parameters parameters;
  parameters.preset = preset.name;
  set_parameters(parameters, preset.values);
  return parameters;
}

std::string parameters_text(const Parameters& parameters) {
  std::string text;
  for (const Knob& knob : knobs()) {
    if (!text.empty()) text += ' ';
    text.append(knob.name).append("=").append(knob.value.show(parameters));
  }
  return text;
}

void set_parameters(Parameters& parameters, std::string_view text) {
  const std::vector<Knob> table = knobs();
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(item.size() + 1, text.size()));
    if (item.empty()) continue;
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string_view name = item.substr(0, equals), value = item.substr(std::min(equals + 1, item.size()));
    const auto knob = std::ranges::find(table, name, &Knob::name);
    if (knob == table.end())
      throw Failure(ExitCode::usage, "there is no parameter named \"" + std::string(name) + "\"");
    if (!knob->value.read(parameters, value))
      throw Failure(ExitCode::usage, "parameter " + std::string(name) + " takes " + knob->value.allowed + ", not \"" +
                                         std::string(value) + "\"");
  }
}

}  // namespace varve
