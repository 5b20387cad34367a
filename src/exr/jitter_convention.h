// What a renderer must be told so that it samples at a jitter: signs, axes and units.
#pragma once

#include <span>
#include <string_view>

#include "exr/jitter_pattern.h"

namespace varve {

/// A row feeds `varve jitter --convention`, `varve help jitter`, and the manual.
struct JitterConvention {
  std::string_view name;
  std::string_view x, y;      ///< columns
  std::string_view meaning;   ///< what the numbers are and where they go
  std::string_view evidence;  ///< how far the row can be trusted
  bool needs_size;            ///< of the picture, in pixels
  Jitter (*convert)(Jitter jitter, double width, double height);
};

/// The first row is what varve itself reads.
std::span<const JitterConvention> jitter_conventions();

}  // namespace varve
