#include "layer_options.h"

#include "option_values.h"
#include "plan/layer_words.h"

namespace varve::cli {

void add_layer_options(std::vector<Option>& rows) {
  constexpr unsigned kInput = kResolve | kProbe | kMeasure | kFloor;
  const auto add = [&rows](const char* name, unsigned commands, Tier tier, const char* help, Value<Settings> value) {
    rows.push_back({name, 0, "WORD", commands, tier, "Layers and transparency", help, std::move(value)});
  };
  add("layers", kInput, Tier::basic,
      "What becomes of the layers that --layer names, the nearest first. A composite is written in the place of the "
      "main color where that is none of them, else as R, G, B, and A. --layers each follows every layer, but is not "
      "exact: where the alpha of a layer and what lies behind it change together, as along an edge that two layers "
      "share, it loses the covariance of the two, 0.25 of 1 at worst.",
      word(
          [](auto& s) -> auto& { return s.job.roles.combine_layers.mode; }, kLayersModes));
  add("layer-order", kInput, Tier::advanced, "What says which layer is in front.",
      word(
          [](auto& s) -> auto& { return s.job.roles.combine_layers.order; }, kLayerOrders));
  add("layer-rule", kInput, Tier::advanced, "Whose motion, depth, normal, and id a pixel of the composite has.",
      word(
          [](auto& s) -> auto& { return s.job.roles.combine_layers.rule; }, kLayerRules));
  add("transmittance", kInput, Tier::advanced, "What tells how much a layer lets through.",
      word(
          [](auto& s) -> auto& { return s.job.roles.combine_layers.transmittance; }, kTransmittances));
  add("write-layers", kResolve, Tier::advanced, "With --layers each: whether the resolved layers are written.",
      word(
          [](auto& s) -> auto& { return s.job.roles.combine_layers.write; }, kWritesLayers));
}

}  // namespace varve::cli
