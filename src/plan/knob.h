// The table of all parameters that can be tuned, by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plan/parameters.h"
#include "plan/value.h"

namespace varve {

/// How early help shows an option.
enum class Tier { basic, advanced, expert };

struct Knob {
  std::string_view name;  ///< in presets, in the parameter dump and, behind --, on the command line
  std::string_view metavar;
  std::string_view group;
  Tier tier;
  std::string_view meaning;  ///< with the unit, and what the ends of the range mean
  Value<Parameters> value;
};

/// In the order of the passes.
std::vector<Knob> knobs();

}  // namespace varve
