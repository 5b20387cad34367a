#include "plan/setting.h"

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "plan/preset.h"

namespace varve {
namespace {

constexpr std::size_t kMost = 1000;

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (bool more = true; more;) {
    const std::size_t end = std::min(text.find(at), text.size());
    more = end < text.size();
    if (end > 0) parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// "gamma=0.5,1" as "gamma=0.5", "gamma=1".
std::vector<std::string> values_of(const std::string& sweep) {
  const std::size_t equals = sweep.find('=');
  std::vector<std::string> values;
  if (equals != std::string::npos)
    for (const std::string& value : split(std::string_view(sweep).substr(equals + 1), ','))
      values.push_back(sweep.substr(0, equals + 1) + value);
  if (values.empty())
    throw Failure(ExitCode::usage,
                  "a sweep is a parameter with its values, such as gamma=0.5,1,2, not '" + sweep + "'");
  return values;
}

void check_names(std::span<const std::string> sweeps) {
  std::vector<std::string> names;
  for (const std::string& sweep : sweeps) {
    const std::string name = sweep.substr(0, sweep.find('='));
    if (std::ranges::find(names, name) != names.end())
      throw Failure(ExitCode::usage, "parameter " + name + " is swept twice; give all its values in one sweep");
    names.push_back(name);
  }
}

std::vector<std::vector<std::string>> combinations(std::span<const std::string> sweeps) {
  std::vector<std::vector<std::string>> all = {{}};
  for (const std::string& sweep : sweeps) {
    std::vector<std::vector<std::string>> longer;
    for (const auto& so_far : all)
      for (const std::string& value : values_of(sweep)) {
        longer.push_back(so_far);
        longer.back().push_back(value);
        if (longer.size() > kMost)
          throw Failure(ExitCode::usage, "the sweeps make more than " + std::to_string(kMost) + " settings");
      }
    all = std::move(longer);
  }
  return all;
}

}  // namespace

std::string Setting::name() const {
  std::string text = preset;
  for (const std::string& value : values) text += " " + value;
  return text;
}

std::vector<std::string> Setting::arguments() const {
  std::vector<std::string> words = {"--preset=" + preset};
  for (const std::string& value : values) words.push_back("--" + value);
  return words;
}

std::vector<Setting> make_settings(std::span<const std::string> presets, std::span<const std::string> sweeps,
                                   std::span<const std::string> singles) {
  check_names(sweeps);
  std::vector<std::vector<std::string>> lists = combinations(sweeps);
  for (const std::string& single : singles) lists.push_back(split(single, ' '));
  std::vector<Setting> settings;
  std::vector<std::string> known;
  for (const std::string& name : presets) {
    const Preset* preset = find_preset(name);
    if (!preset) throw Failure(ExitCode::usage, "there is no preset '" + name + "'; see varve help presets");
    for (const auto& values : lists) {
      Setting setting{name, values, preset_parameters(*preset)};
      for (const std::string& value : values) set_parameters(setting.parameters, value);
      const std::string all = parameters_text(setting.parameters);
      if (std::ranges::find(known, all) != known.end()) continue;
      known.push_back(all);
      settings.push_back(std::move(setting));
    }
  }
  if (settings.size() > kMost)
    throw Failure(ExitCode::usage, "these are more than " + std::to_string(kMost) + " settings");
  return settings;
}

}  // namespace varve
