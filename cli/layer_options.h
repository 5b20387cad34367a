// Options about layers that make one color.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_layer_options(std::vector<Option>& rows);

}  // namespace varve::cli
