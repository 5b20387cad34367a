#include "stages/combine_resolved.h"

#include <utility>

#include "layers/composite.h"
#include "layers/transmittance.h"
#include "samples/mean_of_results.h"
#include "samples/resolve_samples.h"

namespace varve {
namespace {

/// Layers that were accumulated apart, `first` being the place of the nearest.
ResolvedColors::Made composite(const SourceFrame& source, const ColorOutput& output,
                               const std::vector<Resolved>& resolved, std::size_t first, const CombineOptions& options,
                               Workers& workers) {
  std::vector<const Present*> presents;
  std::vector<const Accumulated*> layers;
  std::vector<LayerColor> predictions;
  bool predicted = true;
  for (std::size_t k = first; k < first + output.inputs.size(); ++k) {
    presents.push_back(&source.presents[k]);
    layers.push_back(&resolved[k].accumulated);
    predictions.push_back(layer_color(source.presents[k], resolved[k].prediction));
    predicted = predicted && !resolved[k].prediction.empty();
  }
  ResolvedColors::Made made;
  made.present =
      composite_presents(presents, window_of(source.headers, output), options.roles.combine_layers.rule, true, workers);
  made.resolved.accumulated = composite_resolved(presents, layers, made.present, workers);
  if (predicted) made.resolved.prediction.color = composite_colors(predictions, made.present.color.window(), workers);
  return made;
}

/// Samples that were accumulated apart, or all together: then the result is that of the first, and the others are
/// empty.
ResolvedColors::Made mean_of_samples(const SourceFrame& source, const ColorOutput& output,
                                     const std::vector<Resolved>& resolved, std::size_t first,
                                     const CombineOptions& options, Workers& workers) {
  std::vector<const Present*> presents;
  std::vector<const Accumulated*> results;
  std::vector<const Plane<glm::vec4>*> predictions;
  for (std::size_t k = first; k < first + output.inputs.size(); ++k) {
    presents.push_back(&source.presents[k]);
    if (!resolved[k].accumulated.history.empty()) results.push_back(&resolved[k].accumulated);
    if (!resolved[k].prediction.empty()) predictions.push_back(&resolved[k].prediction.color);
  }
  ResolvedColors::Made made;
  made.present = resolve_samples(presents, SampleFilter::none, workers, options.show);
  if (results.size() > 1) made.resolved.accumulated = mean_of_results(results, workers);
  if (!predictions.empty()) made.resolved.prediction.color = mean_of_colors(predictions, workers);
  return made;
}

}  // namespace

void hold_layers(const SourceFrame& source, std::vector<Resolved>& resolved, Workers& workers) {
  std::size_t next = 0;
  for (const ColorOutput& output : source.headers.outputs) {
    const std::size_t count = output.after ? output.inputs.size() : 1;
    for (std::size_t k = next; output.after && output.combine == Combine::layers && k < next + count; ++k)
      hold_resolved(resolved[k].accumulated.history.color, source.presents[k], workers);
    next += count;
  }
}

ResolvedColors combine_resolved(const SourceFrame& source, const std::vector<Resolved>& resolved,
                                const CombineOptions& options, Workers& workers) {
  ResolvedColors all;
  const auto write = [&](const Subject& subject, const Present& present, const Resolved& r) {
    all.colors.push_back({&subject, &present, &r.accumulated, &r.prediction, nullptr});
  };
  std::size_t next = 0;  // place among what was accumulated
  for (const ColorOutput& output : source.headers.outputs) {
    if (!output.after) {
      write(output.subject, source.presents[next], resolved[next]);
      ++next;
      continue;
    }
    const std::size_t first = next;
    next += output.inputs.size();
    const bool samples = output.combine == Combine::samples;
    const ResolvedColors::Made& made =
        all.made.emplace_back(samples ? mean_of_samples(source, output, resolved, first, options, workers)
                                      : composite(source, output, resolved, first, options, workers));
    write(output.subject, made.present, made.resolved.accumulated.history.empty() ? resolved[first] : made.resolved);
    for (std::size_t i = 0; output.write_inputs && i < output.inputs.size(); ++i)
      write(source.headers.subjects[output.inputs[i]], source.presents[first + i], resolved[first + i]);
  }
  return all;
}

}  // namespace varve
