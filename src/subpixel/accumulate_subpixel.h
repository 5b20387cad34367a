// The accumulator of four sub-pixel histories: a sample is blended into the history of its quarter of the pixel, and a
// pixel is the mean of its four quarters, as all histories together show them now.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "resolve/accumulate.h"
#include "subpixel/blur_table.h"
#include "subpixel/subpixel_history.h"

namespace varve {

/// A quarter of every pixel, as it is shown; where nothing is known of it, what is known of the others.
struct ShownQuarter {
  Plane<glm::vec4> color;
  std::vector<Plane<glm::vec4>> companions;
};

struct SubpixelStep {
  SubpixelHistory history;
  Accumulated resolved;  ///< its history is the picture: color, companions, total, and spread of all four
  std::array<ShownQuarter, kQuadrants> quarters;  ///< filled where SubpixelParameters::scale is 2
};

/// The table of BlurBound::tabulated, to be made once; none where it is not asked for.
std::optional<BlurTable> blur_table_for(const SubpixelParameters& subpixel, const RecursiveParameters& recursive);

/// One frame. `samples` are of the same pixels at the same moment, at least one; their jitter says into which quarter
/// each goes, and those without a jitter count as at the center. Motion and surfaces are those of the first. A present
/// that is valid in some of the pixels only adds to those; its window must be that of the first.
/// Of `recursive` count alpha and its rule, the tests of surfaces, and the bounds; the weight of the present, which is
/// meant for a quarter that is new in every fourth frame, is
/// max(alpha, 1 / (n + 1), what keeps the blur, what keeps the residual).
/// `table` is that of blur_table_for(), null without.
/// Box and rule of `rectify` hold what is reconstructed of a quarter to the neighborhood of the present.
/// The planes of DiagnosticsWanted: `weight` is that of the history in the picture, of the last sample; `reject`, why
/// its quarter had none; `residual` is that sample's, before it counts.
SubpixelStep accumulate_subpixel(std::span<const Present* const> samples, SubpixelHistory history,
                                 const SubpixelParameters& subpixel, const RecursiveParameters& recursive,
                                 const RectifyParameters& rectify, const BlurTable* table, std::uint32_t restart_bit,
                                 const DiagnosticsWanted& wanted, Workers& workers);

}  // namespace varve
