// What a plan says of the rectification.
#pragma once

#include <string>

#include "resolve/accumulate.h"

namespace varve {

/// "variance, gamma 1, of 3x3 pixels in RGB".
std::string describe_box(const RectifyParameters& rectify);

/// "history is clipped towards the present, which removes what is no longer there"; says where a rule is another one
/// under the box that was chosen.
std::string describe_rule(const RectifyParameters& rectify);

}  // namespace varve
