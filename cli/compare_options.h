// Options that only varve compare has.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_compare_options(std::vector<Option>& rows);

}  // namespace varve::cli
