#include "plan/layers_plan.h"

#include <algorithm>

#include "base/error.h"
#include "plan/layer_words.h"

namespace varve {
namespace {

bool combines(const ColorOutput& output) { return output.combine == Combine::layers; }

const ColorOutput* first_stack(const SequenceInfo& info) {
  const auto found = std::find_if(info.first.outputs.begin(), info.first.outputs.end(), combines);
  return found == info.first.outputs.end() ? nullptr : &*found;
}

template <class T, std::size_t N>
std::string word_of(const Word<T> (&words)[N], T value) {
  for (const Word<T>& word : words)
    if (word.value == value) return std::string(word.word);
  return "";
}

bool has_colored_transmittance(const Subject& layer) {
  if (!layer.transmittance) return false;
  const auto& c = layer.transmittance->channels;
  return !(c[0] == c[1] && c[1] == c[2]);
}

}  // namespace

bool composites_after(const SequenceInfo& info) {
  const ColorOutput* stack = first_stack(info);
  return stack && stack->after;
}

PlannedPass layers_pass(const SequenceInfo& info) {
  const ColorOutput* stack = first_stack(info);
  if (!stack)
    return {"layers", false,
            info.first.subjects.size() > 1 ? "each is a color of its own; --layers makes one color of them"
                                           : "there is one layer only"};
  std::string names;
  for (const std::size_t i : stack->inputs) {
    const std::string& layer = info.first.subjects[i].layer;
    names += (names.empty() ? "" : ", ") + (layer.empty() ? "(main)" : layer);
  }
  const std::string count = std::to_string(stack->inputs.size()) + " layers, the nearest first: " + names;
  if (stack->after)
    return {"layers", true,
            count + "; each is resolved by its own motion, then composited" +
                (stack->write_inputs ? ", and written too" : "") +
                "; exact but for the covariance of a layer's alpha with what lies behind it"};
  return {"layers", true,
          count + "; composited first, each pixel follows the layer across which transmittance changes most"};
}

void check_layers(const SequenceInfo& info, const Parameters& parameters) {
  const bool spline = parameters.recursive.history_filter == HistoryFilter::bspline3 ||
                      parameters.recursive.history_filter == HistoryFilter::bspline5;
  const bool carries = parameters.accumulator == Accumulator::gather ||
                       parameters.accumulator == Accumulator::subpixel ||
                       (parameters.accumulator == Accumulator::recursive && !spline);
  for (const ColorOutput& output : info.first.outputs)
    for (const std::size_t i : output.inputs)
      if (output.combine == Combine::layers && output.after && !carries &&
          has_colored_transmittance(info.first.subjects[i]))
        throw Failure(ExitCode::usage,
                      "--layers each resolves the red, green and blue transmittance of layer " +
                          info.first.subjects[i].layer + " along with its color, which " +
                          (spline ? "a B-spline" : "--accumulator two-sided") +
                          " cannot; give --transmittance alpha, --layers composite or --accumulator gather");
}

std::string layers_text(const LayersRequest& request, const SequenceInfo& info) {
  if (!first_stack(info)) return "";
  return " layers=" + word_of(kLayersModes, request.mode) + " layer-order=" + word_of(kLayerOrders, request.order) +
         " layer-rule=" + word_of(kLayerRules, request.rule) +
         " transmittance=" + word_of(kTransmittances, request.transmittance) +
         " write-layers=" + word_of(kWritesLayers, request.write);
}

}  // namespace varve
