// The settings of a measurement: presets times swept parameters.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "plan/parameters.h"

namespace varve {

/// A preset with the parameters that were changed.
struct Setting {
  std::string preset;
  std::vector<std::string> values;  ///< "gamma=1.5", in the order of the sweeps
  Parameters parameters;

  std::string name() const;                    ///< "salvi gamma=1.5 box=none"; unique in a list of make_settings
  std::vector<std::string> arguments() const;  ///< of varve resolve: "--preset=salvi", "--gamma=1.5"
};

/// `sweeps`: "gamma=0.5,1,2"; every combination of their values for each preset, the last sweep varying fastest.
/// `singles`: "box=none gamma=2", one further setting for each preset, after the combinations. Settings that are equal
/// in every parameter are kept once. Throws Failure(usage) for unknown presets, parameters and values, for a parameter
/// that is swept twice, and for more than 1000 settings.
std::vector<Setting> make_settings(std::span<const std::string> presets, std::span<const std::string> sweeps,
                                   std::span<const std::string> singles);

}  // namespace varve
