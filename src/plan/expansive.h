// Why a filter that amplifies cannot read history.
#pragma once

#include <string>
#include <string_view>

#include "resolve/resampling_kernel.h"

namespace varve {

/// One sentence with the figures: what a pass amplifies, by how much, and below which weight of the present it
/// diverges.
std::string expansive_filter_text(std::string_view filter, const LargestGain& gain);

}  // namespace varve
