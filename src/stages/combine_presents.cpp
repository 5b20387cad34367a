#include "stages/combine_presents.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "layers/composite.h"
#include "layers/transmittance.h"
#include "samples/resolve_samples.h"

namespace varve {
namespace {

std::vector<const Present*> pointers(const std::vector<Present>& presents) {
  std::vector<const Present*> all;
  for (const Present& present : presents) all.push_back(&present);
  return all;
}

bool is_gray(const Subject& layer) {
  const std::optional<TransmittanceChannels>& t = layer.transmittance;
  return t && t->channels[0] == t->channels[1] && t->channels[1] == t->channels[2];
}

/// Each layer says what it lets through by itself, within 0 and 1.
void settle_transmittance(const FrameHeaders& headers, const ColorOutput& output, std::vector<Present>& layers,
                          Workers& workers) {
  std::vector<bool> cumulative;
  for (const std::size_t i : output.inputs) {
    const std::optional<TransmittanceChannels>& t = headers.subjects[i].transmittance;
    cumulative.push_back(t && t->cumulative);
  }
  if (std::find(cumulative.begin(), cumulative.end(), true) != cumulative.end())
    separate_transmittance(layers, cumulative, workers);
  for (Present& layer : layers) hold_opacity(layer, workers);
}

/// A stack of layers as all outputs that are made of it accumulate it: as one present, or as each of them.
void combine_layers(const FrameHeaders& headers, std::span<const ColorOutput> outputs, std::vector<Present> layers,
                    const CombineOptions& options, std::vector<Present>& accumulated, Workers& workers) {
  settle_transmittance(headers, outputs.front(), layers, workers);
  std::optional<Present> composite;
  for (const ColorOutput& output : outputs)
    if (!output.after)
      composite = composite_presents(pointers(layers), window_of(headers, output), options.roles.combine_layers.rule,
                                     options.show, workers);
  for (const ColorOutput& output : outputs) {
    if (!output.after) {
      accumulated.push_back(std::move(*composite));
      continue;
    }
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (is_gray(headers.subjects[output.inputs[i]])) fold_into_alpha(layers[i], workers);
      carry_transmittance(layers[i], workers);
      accumulated.push_back(std::move(layers[i]));
    }
  }
}

}  // namespace

const Window& window_of(const FrameHeaders& headers, const ColorOutput& output) {
  return headers.files.front().parts[std::size_t(output.subject.place.part)].data_window;
}

std::vector<bool> are_single_subjects(const FrameHeaders& headers) {
  std::vector<bool> single;
  for (const ColorOutput& output : headers.outputs)
    single.insert(single.end(), output.after ? output.inputs.size() : 1,
                  output.after || output.combine != Combine::layers);
  return single;
}

std::vector<Present> combine_presents(const FrameHeaders& headers, std::vector<Present> read,
                                      const CombineOptions& options, Workers& workers) {
  std::vector<Present> accumulated;
  const std::span<const ColorOutput> outputs = headers.outputs;
  for (std::size_t i = 0; i < outputs.size();) {
    std::vector<Present> inputs;
    for (const std::size_t k : outputs[i].inputs) inputs.push_back(std::move(read[k]));
    std::size_t end = i + 1;
    while (end < outputs.size() && outputs[end].only_compared) ++end;
    if (outputs[i].combine == Combine::layers)
      combine_layers(headers, outputs.subspan(i, end - i), std::move(inputs), options, accumulated, workers);
    else if (outputs[i].combine == Combine::samples && !outputs[i].after)
      accumulated.push_back(resolve_samples(pointers(inputs), options.sample_filter, workers, options.show));
    else
      for (Present& present : inputs) accumulated.push_back(std::move(present));
    i = end;
  }
  return accumulated;
}

}  // namespace varve
