#include "stages/combine_presents.h"

#include <algorithm>
#include <optional>
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

/// Layers of one output: one present, or each of them as it is accumulated by itself.
std::vector<Present> combine_layers(const FrameHeaders& headers, const ColorOutput& output, std::vector<Present> layers,
                                    const CombineOptions& options, Workers& workers) {
  std::vector<bool> cumulative, gray;
  for (const std::size_t i : output.inputs) {
    const std::optional<TransmittanceChannels>& t = headers.subjects[i].transmittance;
    cumulative.push_back(t && t->cumulative);
    gray.push_back(t && t->channels[0] == t->channels[1] && t->channels[1] == t->channels[2]);
  }
  if (std::find(cumulative.begin(), cumulative.end(), true) != cumulative.end())
    separate_transmittance(layers, cumulative, workers);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    hold_opacity(layers[i], workers);
    if (!output.after) continue;
    if (gray[i]) fold_into_alpha(layers[i], workers);
    carry_transmittance(layers[i], workers);
  }
  if (output.after) return layers;
  std::vector<Present> one;
  one.push_back(composite_presents(pointers(layers), window_of(headers, output), options.roles.combine_layers.rule,
                                   options.show, workers));
  return one;
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
  for (const ColorOutput& output : headers.outputs) {
    std::vector<Present> inputs;
    for (const std::size_t i : output.inputs) inputs.push_back(std::move(read[i]));
    if (output.combine == Combine::layers)
      inputs = combine_layers(headers, output, std::move(inputs), options, workers);
    if (output.combine == Combine::samples && !output.after) {
      Present one = resolve_samples(pointers(inputs), options.sample_filter, workers, options.show);
      inputs.clear();
      inputs.push_back(std::move(one));
    }
    for (Present& present : inputs) accumulated.push_back(std::move(present));
  }
  return accumulated;
}

}  // namespace varve
