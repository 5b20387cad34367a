#include "option_values.h"

#include <array>

#include "diagnose/aov.h"
#include "plan/preset.h"

namespace varve::cli {

Value<Settings> map_value() {
  return {[](Settings& s, std::string_view text) {
            const std::size_t equals = text.find('=');
            constexpr std::array<std::string_view, 15> roles = {
                "R",         "G",  "B",        "A",        "depth",    "motion.x", "motion.y",  "forward.x",
                "forward.y", "id", "normal.x", "normal.y", "normal.z", "reactive", "responsive"};
            if (equals == std::string_view::npos || equals + 1 == text.size()) return false;
            const std::string_view role = text.substr(0, equals);
            if (std::ranges::find(roles, role) == roles.end()) return false;
            s.job.roles.map.emplace_back(role, text.substr(equals + 1));
            return true;
          },
          nullptr,
          "role=channel with one of the roles R, G, B, A, depth, motion.x, motion.y, forward.x, forward.y, "
          "id, normal.x, normal.y, normal.z, reactive, responsive",
          {}};
}

Value<Settings> aovs_value() {
  std::string names;
  Value<Settings> value = list(
      [](Settings& s, const std::string& name) {
        if (name != "all" && !find_aov(name)) return false;
        if (std::ranges::find(s.job.request.aovs, name) == s.job.request.aovs.end()) s.job.request.aovs.push_back(name);
        return true;
      },
      "");
  value.choices.push_back({"all", "every plane"});
  for (const Aov& aov : diagnostic_aovs()) {
    value.choices.push_back({std::string(aov.name), std::string(aov.meaning)});
    names += (names.empty() ? "" : ", ") + std::string(aov.name);
  }
  value.allowed = "all, or a list with commas of " + names;
  return value;
}

Value<Settings> assumed_jitter() {
  Value<Settings> value;
  value.allowed = "a pattern such as halton23:16";
  value.read = [](Settings& s, std::string_view text) {
    if (!parse_pattern(text)) return false;
    s.job.jitter = "auto," + std::string(text);
    return true;
  };
  value.show = [](const Settings&) { return std::string(); };
  return value;
}

Value<Settings> samples_value() {
  Value<Settings> value = list(
      [](Settings& s, const std::string& item) {
        SampleRequest& samples = s.job.roles.samples;
        const SampleMode before = samples.mode;
        if (item == "off") samples = {};
        if (item == "resolve") samples.mode = SampleMode::resolve;
        if (item == "each") samples.mode = SampleMode::each;
        if (item == "off" || item == "resolve" || item == "each") return true;
        const auto edge =
            item.starts_with("grid:") ? parse_number<int>(std::string_view(item).substr(5)) : std::nullopt;
        constexpr int kWidest = 16;
        if (!edge || *edge < 2 || *edge > kWidest) return false;
        samples.grid = *edge;
        if (before == SampleMode::off) samples.mode = SampleMode::resolve;
        return true;
      },
      "off, resolve or each, and grid:2 to grid:16 where the picture itself is a grid of samples, with commas between");
  value.choices.push_back({"off", "numbered parts and layers are like all others"});
  value.choices.push_back({"resolve", "they are resolved to the pixel first, which costs what one sample costs"});
  value.choices.push_back({"each",
                           "each is resolved over time, then they are to the pixel; with --accumulator gather "
                           "all meet in it"});
  value.choices.push_back(
      {"grid:2", "the samples are 2 x 2 pixels of a picture that is twice as wide and as high; up to grid:16"});
  return value;
}

Value<Settings> preset_value() {
  Value<Settings> value;
  for (const Preset& row : presets()) value.choices.push_back({std::string(row.name), std::string(row.description)});
  value.allowed = choices_text(value.choices);
  value.read = [](Settings& s, std::string_view name) {
    const Preset* row = find_preset(name);
    if (row) s.job.parameters = preset_parameters(*row);
    return row != nullptr;
  };
  value.show = [](const Settings& s) { return s.job.parameters.preset; };
  return value;
}

Value<Settings> convention_value() {
  Value<Settings> value;
  value.choices.push_back({"auto", "told by the names of the channels; refused where the names do not tell"});
  value.choices.push_back({"none", "vectors are not used: every pixel is taken to be at rest"});
  for (const MotionConvention& row : motion_conventions())
    value.choices.push_back({std::string(row.name), std::string(row.note)});
  value.allowed = choices_text(value.choices);
  value.read = [](Settings& s, std::string_view text) {
    if (text != "auto" && text != "none" && !find_motion_convention(text)) return false;
    s.job.roles.convention = text;
    return true;
  };
  value.show = [](const Settings& s) { return s.job.roles.convention; };
  return value;
}

Value<Settings> size_value(std::function<void(Settings&, int width, int height)> set) {
  return {[set](Settings& s, std::string_view text) {
            const std::size_t x = std::min(text.find('x'), text.size());
            const auto width = parse_number<int>(text.substr(0, x));
            const auto height = parse_number<int>(text.substr(std::min(x + 1, text.size())));
            constexpr int kLongest = 16384;
            if (!width || !height || *width < 1 || *height < 1 || *width > kLongest || *height > kLongest) return false;
            set(s, *width, *height);
            return true;
          },
          nullptr,
          "width x height in pixels, 1 to 16384 each, such as 320x180",
          {}};
}

Value<Settings> yardsticks_value() {
  return list(
      [](Settings& s, const std::string& text) {
        const auto n = parse_number<int>(text);
        if (!n || *n < 1 || *n > 64) return false;
        if (std::ranges::find(s.synth.yardsticks, *n) == s.synth.yardsticks.end()) s.synth.yardsticks.push_back(*n);
        return true;
      },
      "a list with commas of numbers from 1 to 64, such as 2,3,4,6");
}

Value<Settings> knob_value(const Knob& knob) {
  return inside<Settings>(
      knob.value, [](auto& s) -> auto& { return s.job.parameters; });
}

}  // namespace varve::cli
