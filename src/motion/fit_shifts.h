// Motion that varies smoothly over a surface, from what its cells found one by one.
#pragma once

#include <vector>

#include "motion/find_shift.h"

namespace varve {

/// Motion as an affine function of the pixel.
struct ShiftModel {
  glm::dvec2 middle{0}, shift{0}, per_x{0}, per_y{0};  ///< px; shift at `middle`, and its change per pixel
  bool known = false;

  glm::dvec2 at(int x, int y) const { return shift + (x - middle.x) * per_x + (y - middle.y) * per_y; }
};

/// A model for each cell that found something, from the cells of its surface within three blocks: least squares in
/// which every cell counts by how sharply its light tells each direction (so a striped cell says nothing along its
/// stripes), outliers turned down step by step. Where one model for the whole surface explains its cells as well, that
/// is taken: fewer unknowns, less noise.
std::vector<ShiftModel> fit_shifts(const VectorCells& cells, const std::vector<FoundShift>& found, Workers& workers);

}  // namespace varve
