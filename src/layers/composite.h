// Many layers, one color: as presents before they are accumulated, or as what came of each.
#pragma once

#include <span>
#include <vector>

#include "base/combine_request.h"
#include "resolve/accumulate.h"
#include "resolve/present.h"

namespace varve {

/// Layers over each other, front to back, at one frame. The window is that of all layers and `at_least` together; where
/// a layer has no data it lets everything through. Color is premultiplied over in linear light; motion, depth, id,
/// normal and masks are those of the layer that `rule` chooses, the background's where it lets most light through (at
/// rest, or as the last layer's file says). Companions stand one after the other. Vectors as stored or dilated: a pixel
/// takes one as it is. `show`: fill Present::combined.
Present composite_presents(std::span<const Present* const> layers, const Window& at_least, LayerRule rule, bool show,
                           Workers& workers);

/// A layer that is accumulated by itself takes its transmittance along, as the last of its companions.
void carry_transmittance(Present& layer, Workers& workers);

/// A resolved layer, for composite_colors().
struct LayerColor {
  const Plane<glm::vec4>* color = nullptr;
  const Plane<glm::vec4>* transmittance = nullptr;  ///< R G B; null: one minus alpha
};
LayerColor layer_color(const Present& present, const History& history);

/// Over each other, front to back, over `window`; nothing where a layer has no data.
Plane<glm::vec4> composite_colors(std::span<const LayerColor> layers, const Window& window, Workers& workers);

/// What came of each layer, composited. `presents`: of the layers; `composite`: composite_presents() of them with
/// `show`, which says whose counts and diagnostics a pixel has.
Accumulated composite_resolved(std::span<const Present* const> presents, std::span<const Accumulated* const> layers,
                               const Present& composite, Workers& workers);

}  // namespace varve
