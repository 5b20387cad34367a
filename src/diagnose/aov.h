// The diagnostic planes: one table feeds the writer, the previews, --help and the manual.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/raw_plane.h"
#include "base/reject.h"

namespace varve {

/// Who can fill a plane, a sum of these.
inline constexpr unsigned kByRecursive = 1, kByTwoSided = 2, kByGather = 4, kBySubpixel = 8, kByAll = 15;

struct Aov {
  std::string_view name;        ///< as given to --aov; the channel is varve.<name>[.<component>]
  std::string_view components;  ///< "" for one channel, else one letter each: "xy"
  PixelType type;
  std::string_view unit;
  std::string_view range;
  std::string_view colormap;         ///< OpenImageIO color map for --preview
  double preview_low, preview_high;  ///< values shown as the ends of the color map
  std::string_view meaning;
  unsigned filled_by = kByAll;
  bool only_by_name = false;  ///< costs work of its own: `all` does not mean it
};

std::span<const Aov> diagnostic_aovs();
const Aov* find_aov(std::string_view name);

/// "--accumulator two-sided or gather": who fills it.
std::string accumulators_of(const Aov& aov);

/// The bits of the plane `reject`, for help and manual.
struct RejectName {
  std::uint32_t bit;
  std::string_view name, meaning;
};
std::span<const RejectName> reject_bits();

}  // namespace varve
