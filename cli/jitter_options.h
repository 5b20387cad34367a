// The part of the table of options that belongs to varve jitter.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_jitter_options(std::vector<Option>& rows);

}  // namespace varve::cli
