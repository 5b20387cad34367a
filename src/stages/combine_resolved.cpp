#include "stages/combine_resolved.h"

#include <algorithm>
#include <cmath>
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

/// |a - b| over the longer of both, red, green and blue together; 0 where both are black. Of the same window.
Plane<float> relative_difference(const Plane<glm::vec4>& a, const Plane<glm::vec4>& b, Workers& workers) {
  const Window& w = a.window();
  Plane<float> out(w);
  const auto length = [](const glm::dvec3& c) { return std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z); };
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::dvec3 p(a.at(x, y)), q(b.at(x, y));
      const double size = std::max(length(p), length(q));
      out.at(x, y) = size > 0 ? float(length(p - q) / size) : 0.0f;
    }
  });
  return out;
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
    all.colors.push_back({&subject, &present, &r.accumulated, &r.prediction, nullptr, nullptr, nullptr});
    if (!r.quarters.front().color.empty()) all.colors.back().quarters = r.quarters;
  };
  const auto tell_repair = [&](std::size_t k) {
    if (k < source.repairs.size()) all.colors.back().repair = &source.repairs[k];
  };
  std::size_t next = 0;     // place among what was accumulated
  std::size_t compare = 0;  // place of the color that the next one may be compared with
  for (const ColorOutput& output : source.headers.outputs) {
    const std::size_t first = next;
    next += output.after ? output.inputs.size() : 1;
    if (output.after)
      all.made.push_back(output.combine == Combine::samples
                             ? mean_of_samples(source, output, resolved, first, options, workers)
                             : composite(source, output, resolved, first, options, workers));
    const Present& present = output.after ? all.made.back().present : source.presents[first];
    // Samples that were gathered together have made one result already, that of the first.
    const bool stands = !output.after || all.made.back().resolved.accumulated.history.empty();
    const Resolved& made = stands ? resolved[first] : all.made.back().resolved;
    if (output.only_compared) {
      const Plane<glm::vec4>& color = all.colors[compare].accumulated->history.color;
      all.differences.push_back(relative_difference(color, made.accumulated.history.color, workers));
      all.colors[compare].difference = &all.differences.back();
      continue;
    }
    compare = all.colors.size();
    write(output.subject, present, made);
    if (!output.after) tell_repair(first);
    for (std::size_t i = 0; output.write_inputs && output.after && i < output.inputs.size(); ++i) {
      write(source.headers.subjects[output.inputs[i]], source.presents[first + i], resolved[first + i]);
      tell_repair(first + i);
    }
  }
  return all;
}

}  // namespace varve
