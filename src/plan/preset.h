// Named sets of parameter values, and parameters as text.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "plan/parameters.h"

namespace varve {

struct Preset {
  std::string_view name;
  std::string_view source;       ///< where the recipe comes from
  std::string_view description;  ///< one line
  std::string_view values;       ///< "name=value ...": knobs that it sets, the others keep their defaults
};

/// In the order of `varve help presets`.
std::span<const Preset> presets();
const Preset* find_preset(std::string_view name);

/// Default parameters with the values of the preset.
Parameters preset_parameters(const Preset& preset);

/// Every knob as "name=value", in the order of knobs(), one blank between. Numbers are the shortest that read back as
/// the same. The name of the preset is left out: equal values are equal work.
std::string parameters_text(const Parameters& parameters);

/// Sets the knobs that a text of the form of parameters_text names. Throws Failure(usage) naming the knob, the value
/// and what it takes.
void set_parameters(Parameters& parameters, std::string_view text);

}  // namespace varve
