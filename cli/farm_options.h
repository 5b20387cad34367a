// Options of runs that are parts of something larger: chunks of a shot, frames that are still being rendered.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_farm_options(std::vector<Option>& rows);

}  // namespace varve::cli
