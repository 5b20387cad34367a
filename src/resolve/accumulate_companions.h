// What becomes of the channels that go with a color: the same pixels of the history, moved as the color's history was,
// blended by the same weight. Channels that add up to the color still do.
#pragma once

#include <functional>
#include <vector>

#include <glm/vec4.hpp>

#include "base/plane.h"
#include "resolve/accumulate.h"
#include "resolve/accumulate_row.h"
#include "resolve/companion_move.h"
#include "resolve/row_passes.h"

namespace varve {

/// The companions of one frame, as the row pass sees them.
struct CompanionPass {
  CompanionRows color;                ///< the color itself
  std::vector<CompanionRows> planes;  ///< its companions
  std::vector<PixelRows<float>> out;
  std::vector<Plane<glm::vec4>> reconstructed;  ///< kept for the rows above
  bool empty() const { return planes.empty(); }
};

/// What makes the present of a plane from its samples.
using Reconstruct = std::function<Plane<glm::vec4>(const Plane<glm::vec4>& samples)>;

/// Prepares the pass over present.companions and allocates their planes in `out`. `view` is that of the color, of which
/// `reconstruct` must be what its present was made by; empty: the samples are the present.
CompanionPass view_companions(const AccumulateView& view, const Present& present, const History& previous,
                              const Reconstruct& reconstruct, History& out);

/// One row, after the color's and all of its row passes: `scratch` still holds its rectified history, and
/// view.out_color and view.out_weight are written.
void accumulate_companions(const AccumulateView& view, int y, const RowScratch& scratch, const RowPassView& passes,
                           const CompanionPass& pass);

}  // namespace varve
