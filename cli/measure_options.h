// Options that only varve measure has.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_measure_options(std::vector<Option>& rows);

}  // namespace varve::cli
