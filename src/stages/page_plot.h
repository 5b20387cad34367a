// A small plot as inline SVG.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace varve {

/// Figures over frames; NaN and infinities leave gaps. `limit` is drawn as a dashed line.
std::string page_plot(const std::vector<int>& frames, const std::vector<double>& values, std::optional<double> limit);

}  // namespace varve
