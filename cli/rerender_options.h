// Options about further samples: which are lacking, and those that were rendered.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_rerender_options(std::vector<Option>& rows);

}  // namespace varve::cli
