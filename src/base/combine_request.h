// What the user says about several layers or samples that make one color.
#pragma once

namespace varve {

/// What becomes of several layers: each is resolved and written as a color of its own; or they are composited front to
/// back and the composite is resolved (Salvi 2016); or each is resolved by its own motion, and the results composited.
enum class LayersMode { apart, composite, each };

/// Front to back: as --layer lists them, by the depth of the first frame on disk, or by name (a number in it counts as
/// a number).
enum class LayerOrder { list, depth, name };

/// What a layer lets through: found by the names of its channels; one minus its alpha; transmittance channels of each
/// layer by itself; or of the layer and all in front of it.
enum class TransmittanceKind { automatic, alpha, layer, cumulative };

/// Whose motion a pixel of the composite follows: that of the layer across which transmittance changes most (Salvi
/// 2016), or that of the layer which adds most light.
enum class LayerRule { variation, contribution };

struct LayersRequest {
  LayersMode mode = LayersMode::apart;
  LayerOrder order = LayerOrder::list;
  TransmittanceKind transmittance = TransmittanceKind::automatic;
  LayerRule rule = LayerRule::variation;
  bool write = false;       ///< under `each`: the resolved layers too, in their own places
  bool difference = false;  ///< the other mode is worked out as well, to be compared with this one
};

}  // namespace varve
