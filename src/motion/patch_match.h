// Where small patches of one picture lie in another one: motion measured from pixels, to hold stored vectors against.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// A picture for matching: tone L / (L + middle) of the mean of R, G and B, so that highlights do not outweigh the
/// rest, slightly blurred against aliasing, and halved again and again. Level k has pixels of 2^k, aligned to display
/// pixel 0, so that levels of different windows match.
struct TonePyramid {
  std::vector<Plane<float>> levels;
  const Plane<float>& fine() const { return levels.front(); }
};

/// Brightness that becomes tone 0.5: the median of the positive ones; 1 for black. `color` is finite.
double middle_brightness(const Plane<glm::vec4>& color);

/// Levels go on as long as the shorter side keeps 40 pixels, at most `levels`.
TonePyramid tone_pyramid(const Plane<glm::vec4>& color, double middle, Workers& workers, std::size_t levels = 16);

/// Edge of a patch is 2 * kPatchRadius + 1 pixels.
inline constexpr int kPatchRadius = 5;

/// How unlike two patches are whatever their brightness, 0 for the same, about 1 for strangers: 1 - 2 cov / (var +
/// var). The patch around pixel (x, y) of `from` against the one of `to` that lies `moved` away, between pixels
/// bilinear. None where one of them leaves its window.
std::optional<double> patch_difference(const Plane<float>& from, int x, int y, const Plane<float>& to,
                                       const glm::dvec2& moved);

/// A place with texture in both directions.
struct Place {
  int x = 0, y = 0;
};

/// Texture in both directions around a pixel: the smaller eigenvalue of the gradients' moments (Shi and Tomasi 1994).
/// The pixel lies kPatchRadius + 1 inside the picture.
double texture_at(const Plane<float>& tone, int x, int y);

inline constexpr double kLeastTexture = 1e-5;  ///< of a place: gradients of 0.003 a pixel in either direction

/// The place with the most texture in each cell of a grid of about `count` cells, in reading order; cells without any
/// have none.
std::vector<Place> textured_places(const Plane<float>& tone, int count, Workers& workers);

/// A place that was found again.
struct MatchedPlace {
  Place place;
  glm::dvec2 moved{0};    ///< pixel position in the other picture minus the one here, pixels, y down
  double difference = 0;  ///< patch_difference there: the noise floor
};

/// Looks every place up in `to`: searched on every level, refined to fractions of a pixel. Kept are those that are like
/// the patch, that no other place of the search is nearly as like, and whose way back leads to where it began. Reach:
/// 8 pixels of the coarsest level. The same for any number of workers.
std::vector<MatchedPlace> match_places(const TonePyramid& from, const TonePyramid& to, const std::vector<Place>& places,
                                       Workers& workers);

}  // namespace varve
