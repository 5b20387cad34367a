// The tables behind `varve help TOPIC` and the manual sections.
#include <algorithm>

#include "base/error.h"
#include "diagnose/aov.h"
#include "diagnose/metric.h"
#include "exr/jitter_convention.h"
#include "help.h"
#include "plan/feature.h"
#include "plan/knob.h"
#include "plan/preset.h"
#include "report.h"
#include "rerender_topic.h"
#include "synth/scenes.h"

namespace varve::cli {
namespace {

struct ExitMeaning {
  ExitCode code;
  std::string_view meaning;
};
constexpr ExitMeaning kExitMeanings[] = {
    {ExitCode::done, "Done."},
    {ExitCode::differences, "varve compare found differences, or a limit that does not hold."},
    {ExitCode::usage, "The command line is wrong: an unknown option, a bad value, something missing."},
    {ExitCode::input, "Input is missing, unreadable or damaged."},
    {ExitCode::inconsistent, "Inputs do not fit together, or what is asked for needs what is not there."},
    {ExitCode::output, "Output could not be written. Files written before stay valid."},
    {ExitCode::self_check, "A check of the program's own work failed. This is a defect of the program."},
    {ExitCode::interrupted, "Interrupted (SIGINT). Files written before stay valid; --resume goes on."},
    {ExitCode::terminated, "Terminated (SIGTERM), likewise."},
};

std::string encoding_text(std::string_view x, std::string_view y, const MotionEncoding& e, std::string_view where) {
  std::string text = std::string(x) + ", " + std::string(y) + " lead to the " + std::string(where) + " frame";
  text += e.unit == MotionUnit::pixel  ? " in pixels"
          : e.unit == MotionUnit::unit ? " in fractions of the display window"
                                       : " in -1 to 1 across the display window";
  if (e.sign_x < 0) text += ", x turned round";
  if (e.sign_y < 0) text += ", y turned round";
  if (e.bias != 0) text += ", bias " + number_text(e.bias);
  if (e.scale != 1) text += ", scale " + number_text(e.scale);
  if (e.shutter != 1) text += ", shutter " + number_text(e.shutter);
  return text + ". ";
}

Topic presets_topic() {
  Topic topic{"presets",
              "PRESETS",
              "Sets of parameters for --preset, then every parameter with its value in each of them. Options given by "
              "name override them.",
              {}};
  for (const Preset& preset : presets())
    topic.rows.emplace_back(preset.name,
                            std::string(preset.description) + " Source: " + std::string(preset.source) + ".");
  for (const Knob& knob : knobs()) {
    // Presets of one value together: "catmull-rom: salvi, lopez; bilinear: crytek2, inside".
    std::vector<std::pair<std::string, std::string>> values;
    for (const Preset& preset : presets()) {
      const std::string value = knob.value.show(preset_parameters(preset));
      const auto found = std::ranges::find(values, value, [](const auto& entry) { return entry.first; });
      if (found == values.end())
        values.emplace_back(value, preset.name);
      else
        found->second.append(", ").append(preset.name);
    }
    std::string text;
    for (const auto& [value, names] : values)
      text += (text.empty() ? "" : "; ") + value + (values.size() == 1 ? " in all" : ": " + names);
    topic.rows.emplace_back("--" + std::string(knob.name), text + ".");
  }
  return topic;
}

Topic features_topic() {
  Topic topic{"features",
              "FEATURES",
              "What the sources of temporal supersampling describe, by number, and how it is reached here. Sources: S "
              "Salvi 2016, L Lopez, Y Yang 2009, W Wronski 2014, P Pedersen 2016. Systems first, then techniques, then "
              "what goes beyond them.",
              {}};
  for (const Feature& feature : features())
    topic.rows.emplace_back(feature_name(feature),
                            std::string(feature.what) +
                                (feature.sources.empty() ? "" : " (" + std::string(feature.sources) + ")") + ". " +
                                std::string(reach_name(feature.reach)) + ": " + std::string(feature.how) + ".");
  return topic;
}

Topic aovs_topic() {
  Topic topic{
      "aovs",
      "DIAGNOSTIC PLANES",
      "Planes for --aov and --diagnostics. The channels are named varve.NAME, under the layer that was resolved.",
      {}};
  for (const Aov& aov : diagnostic_aovs())
    topic.rows.emplace_back(aov.name, std::string(aov.meaning) + " Unit: " + std::string(aov.unit) +
                                          ". Range: " + std::string(aov.range) + "." +
                                          (aov.filled_by == kByAll ? "" : " Only of " + accumulators_of(aov) + "."));
  return topic;
}

Topic rejection_topic() {
  Topic topic{"rejection", "REJECTION BITS", "The plane reject is a sum of these.", {}};
  for (const RejectName& bit : reject_bits())
    topic.rows.emplace_back(std::to_string(bit.bit) + " " + std::string(bit.name), std::string(bit.meaning) + ".");
  return topic;
}

Topic conventions_topic() {
  Topic topic{
      "conventions",
      "CONVENTIONS",
      "How renderers write motion vectors, for --convention. A vector is decoded as sign * ((v - bias) * scale) / "
      "shutter. Evidence tells how far a row can be trusted.",
      {}};
  for (const MotionConvention& row : motion_conventions()) {
    std::string text;
    if (!row.backward_x.empty()) text += encoding_text(row.backward_x, row.backward_y, row.backward, "previous");
    if (!row.forward_x.empty()) text += encoding_text(row.forward_x, row.forward_y, row.forward, "next");
    if (!row.layers.empty()) text += "Layers: " + std::string(row.layers) + ". ";
    text += row.evidence == Evidence::measured     ? "Evidence: measured. "
            : row.evidence == Evidence::documented ? "Evidence: documented. "
                                                   : "Evidence: unverified. ";
    topic.rows.emplace_back(row.name, text + std::string(row.note));
  }
  return topic;
}

Topic metrics_topic() {
  Topic topic{"metrics",
              "METRICS",
              "Figures of varve compare, for --metrics, --fail and --warn. A is the reference, b - a the difference.",
              {}};
  for (const Metric& metric : metrics()) {
    std::string text(metric.meaning);
    if (!metric.unit.empty()) text += " Unit: " + std::string(metric.unit) + ".";
    text += metric.better == Better::up ? " More is better." : " Less is better.";
    topic.rows.emplace_back(metric.name, text);
  }
  return topic;
}

Topic scenes_topic() {
  Topic topic{
      "scenes", "SCENES", "What `varve synth` renders. Each scene provokes one thing that breaks a resolver.", {}};
  for (const synth::SceneRow& row : synth::scene_table()) topic.rows.emplace_back(row.name, std::string(row.provokes));
  return topic;
}

Topic patterns_topic() {
  Topic topic{"patterns",
              "JITTER PATTERNS",
              "Sample positions for `varve jitter` and for --jitter PATTERN:N. Patterns without a length of their own "
              "take N points, 16 without it.",
              {}};
  for (const JitterPattern& row : jitter_patterns())
    topic.rows.emplace_back(row.name, std::string(row.meaning) + ". " +
                                          (row.length == 0   ? "Up to " + std::to_string(row.most) + " points"
                                           : row.length == 1 ? std::string("1 point")
                                                             : std::to_string(row.length) + " points") +
                                          ". Source: " + std::string(row.source) + ".");
  return topic;
}

Topic jitter_conventions_topic() {
  Topic topic{
      "jitter-conventions",
      "JITTER CONVENTIONS",
      "What a renderer must be told so that it samples at jx, jy, for `varve jitter --convention`. Evidence tells "
      "how far a row can be trusted; `varve probe` cannot see a wrong one.",
      {}};
  for (const JitterConvention& row : jitter_conventions())
    topic.rows.emplace_back(row.name, std::string(row.meaning) + " Columns: " + std::string(row.x) + ", " +
                                          std::string(row.y) + ". Evidence: " + std::string(row.evidence) + ".");
  return topic;
}

Topic exit_topic() {
  Topic topic{"exit-codes", "EXIT STATUS", "", {}};
  for (const ExitMeaning& row : kExitMeanings)
    topic.rows.emplace_back(std::to_string(int(row.code)), std::string(row.meaning));
  return topic;
}

}  // namespace

std::vector<Topic> topics() {
  return {presets_topic(),  features_topic(), aovs_topic(),   rejection_topic(), conventions_topic(),
          report_topic(),   metrics_topic(),  scenes_topic(), patterns_topic(),  jitter_conventions_topic(),
          rerender_topic(), exit_topic()};
}

std::string topic_names() {
  std::string names;
  for (const Topic& topic : topics()) names += (names.empty() ? "" : ", ") + topic.name;
  return names;
}

}  // namespace varve::cli
