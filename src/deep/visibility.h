// How much of each deep sample is seen, volumes that overlap included.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "deep/deep_sample.h"

namespace varve {

/// Where the samples of one pixel lie among each other. The depths at which one begins or ends cut the ray into
/// intervals; in an interval a volume is either everywhere or nowhere.
struct DeepLayout {
  std::vector<double> cuts;  ///< depths, ascending; interval j reaches from cuts[j] to cuts[j + 1]
  struct Range {
    std::uint32_t first = 0, last = 0;  ///< intervals first <= j < last; equal for a point, which lies at cuts[first]
  };
  std::vector<Range> ranges;  ///< one for each sample
  bool volumes = false;       ///< there are any
};

/// `samples` sorted by is_before().
void lay_out(std::span<const DeepSample> samples, DeepLayout& layout);

/// Room that is used again from pixel to pixel.
struct VisibilityScratch {
  std::vector<double> rates, seen, walls;
};

/// Visibility of sample i: the transmittance in front of it, averaged over the sample by what it sends to the eye.
/// The flattened color is the sum of visibility times color, and transmittance changes across the sample by visibility
/// times opacity. Those sums are what is left when every volume is split where another begins or ends, coincident
/// pieces are merged as the limit of interleaved slices, and the pieces composited front to back ("Interpreting OpenEXR
/// Deep Pixels"); without forming the pieces, n samples cost n log n whatever overlaps. An opaque volume hides those
/// that it coincides with; several share alike. `opacity[i]` 0..1 is that of one channel; `visibility` gets as many
/// entries.
void find_visibility(const DeepLayout& layout, std::span<const double> opacity, std::span<double> visibility,
                     VisibilityScratch& scratch);

}  // namespace varve
