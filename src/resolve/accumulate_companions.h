// What becomes of the channels that go with a color: the same pixels of the history, moved as the color's history was,
// blended by the same weight. Channels that add up to the color still do.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "base/parallel.h"
#include "resolve/accumulate.h"
#include "resolve/accumulate_row.h"
#include "resolve/companion_move.h"
#include "resolve/sample_weights.h"

namespace varve {

/// The companions of one frame, as the row pass sees them.
struct CompanionPass {
  CompanionRows color;                ///< the color itself
  std::vector<CompanionRows> planes;  ///< its companions
  std::vector<PixelRows<float>> out;
  std::vector<WeighedPresent> weighed;  ///< kept for the rows above
  bool empty() const { return planes.empty(); }
};

/// Prepares the pass over present.companions and allocates their planes in `out`. `view` is that of the color. Samples
/// are weighed by their position where the color's are.
CompanionPass view_companions(const AccumulateView& view, const Present& present, const History& previous,
                              SampleFilter sample_filter, std::optional<glm::dvec2> jitter, History& out,
                              Workers& workers);

/// One row, after the color's: `scratch` still holds its rectified history, and view.out_color and view.out_weight are
/// written.
void accumulate_companions(const AccumulateView& view, int y, const RowScratch& scratch, const CompanionPass& pass);

}  // namespace varve
