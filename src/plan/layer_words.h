// The words of the choices about layers, as written on the command line and in the parameters of an output.
#pragma once

#include "base/combine_request.h"
#include "plan/value.h"

namespace varve {

constexpr Word<LayersMode> kLayersModes[] = {
    {"apart", LayersMode::apart, "each is resolved and written as a color of its own"},
    {"composite", LayersMode::composite,
     "composited first; a pixel follows the layer where transmittance changes most"},
    {"each", LayersMode::each, "each is resolved by its own motion, then composited"},
};
constexpr Word<LayerOrder> kLayerOrders[] = {
    {"list", LayerOrder::list, "as --layer lists them, the nearest first"},
    {"depth", LayerOrder::depth, "by the median depth of each in the first frame on disk"},
    {"name", LayerOrder::name, "by name, numbers in it as numbers: layer.2 before layer.10"},
};
constexpr Word<LayerRule> kLayerRules[] = {
    {"variation", LayerRule::variation, "the layer across which transmittance changes most; the background competes"},
    {"contribution", LayerRule::contribution, "the layer that adds most light: for what shines without covering"},
};
constexpr Word<TransmittanceKind> kTransmittances[] = {
    {"auto", TransmittanceKind::automatic, "channels of each layer by itself where names tell of them, else alpha"},
    {"alpha", TransmittanceKind::alpha, "one minus alpha, whatever else there is"},
    {"layer", TransmittanceKind::layer, "channels such as LAYER.T, LAYER.transmittance.R or LAYER.AR, of the layer"},
    {"cumulative", TransmittanceKind::cumulative, "such channels, of the layer and all in front of it"},
};
constexpr Word<bool> kWritesLayers[] = {
    {"on", true, "each resolved layer is written in its own place, too"},
    {"off", false, "only the composite; the layers stay as they were"},
};

}  // namespace varve
