// The part of the table of options that belongs to varve synth.
#pragma once

#include <vector>

#include "option.h"

namespace varve::cli {

void add_synth_options(std::vector<Option>& rows);

}  // namespace varve::cli
