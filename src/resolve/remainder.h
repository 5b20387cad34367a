// What a float cannot hold of a long mean: kept beside it, so that a present that counts little is not lost.
#pragma once

#include "resolve/row_passes.h"

namespace varve {

/// Whether the history keeps what rounding takes from it. A float stands still where alpha times the difference falls
/// below its step: up to 6e-8 / alpha of the color are lost, 6 % at an alpha of 1e-6, and a mean of 100 000 frames is
/// off by 8e-6. From an alpha of 0.01 on it does not matter. Blends that are no weighted mean keep nothing.
bool keeps_remainder(const RecursiveParameters& parameters);

/// After the blend: blends once more with the remainder of the history and notes the new one. Only where history was
/// read at a pixel and nothing moved it; between pixels it is resampled anyway, and begins again without remainder.
/// Needs RowPassView::weighs. `remainder` has the window of the present.
void blend_remainder(const RowPassView& pass, int y, const RowScratch& scratch, const RowPassScratch& extra,
                     Plane<glm::vec4>& remainder);

}  // namespace varve
