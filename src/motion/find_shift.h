// Where the pixels of a cell went: a small photometric search.
#pragma once

#include <vector>

#include "motion/vector_cells.h"

namespace varve {

/// Motion of a cell that the pixels show.
struct FoundShift {
  glm::dvec2 shift{0};            ///< pixels, as a vector
  double cost = kWorstMisfit;     ///< mean misfit with it, 0 to kWorstMisfit
  double xx = 0, xy = 0, yy = 0;  ///< how sharply the light tells it: inverse covariance of the shift, 1/px^2
  bool found = false;
};

/// Searches for each cell that is `asked` for: every whole shift up to 8 px from the stored vectors, then, where that
/// explains too little, up to `reach` px in a picture of quarter size, where the object of that id went as a whole, and
/// what `camera` (may be empty) says; then what neighbors of the same surface found; then fractions of a pixel by least
/// squares (Lucas and Kanade 1981) over 16x16 pixels of the surface.
std::vector<FoundShift> find_shifts(const SeenPair& pair, const VectorCells& cells, const std::vector<char>& asked,
                                    const Plane<std::uint32_t>& labels, const Plane<glm::vec2>& camera, int reach,
                                    Workers& workers);

}  // namespace varve
