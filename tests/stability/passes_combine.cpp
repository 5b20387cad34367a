#include <cmath>

#include "deep/flatten.h"
#include "gather/gather.h"
#include "gather/round_trip.h"
#include "gather/shading_gain.h"
#include "layers/composite.h"
#include "layers/transmittance.h"
#include "plan/knob_words.h"
#include "samples/mean_of_results.h"
#include "samples/resolve_samples.h"
#include "stability/passes.h"

namespace varve::stability {
namespace {

std::vector<Present> presents_of(const RawShot& shot, Workers& workers) {
  std::vector<Present> presents;
  for (const RawFrame& frame : shot) presents.push_back(present_of(frame, workers));
  return presents;
}

std::vector<const Present*> pointers(const std::vector<Present>& presents) {
  std::vector<const Present*> list;
  for (const Present& p : presents) list.push_back(&p);
  return list;
}

/// All frames of the shot around the middle one, as the stages hand them to the gather.
Planes gather_all(const RawShot& shot, const GatherParameters& p, bool marks, Workers& w) {
  std::vector<Present> presents = presents_of(shot, w);
  for (Present& present : presents)
    if (!marks) present.id = {}, present.depth = {};
  const std::size_t middle = shot.size() / 2;
  const SurfaceTest test = surface_test(presents.front());
  std::vector<SurfaceBlocks> blocks;
  std::vector<Plane<float>> light;
  std::vector<Plane<LightRange>> range;
  for (const Present& present : presents) {
    blocks.push_back(summarize_surfaces(present));
    light.push_back(local_light(present.color, present, test, p.gain_window, w));
    range.push_back(local_range(present.color, present, test, w));
  }
  std::vector<GatherSource> sources;
  for (std::size_t i = 0; i < presents.size(); ++i) {
    GatherSource s;
    s.present = &presents[i], s.jitter = shot[i].jitter, s.blocks = &blocks[i];
    if (i > 0) s.backward = &presents[i].motion;
    if (i + 1 < presents.size()) s.forward = &presents[i].forward;
    if (p.gain) s.local_light = &light[i], s.light_range = &range[i];
    sources.push_back(s);
  }
  DiagnosticsWanted wanted{false, true, false, true, true};
  Accumulated done = gather(sources, middle, p, test, wanted, w);
  Planes planes;
  planes.colors.push_back(std::move(done.history.color));
  planes.numbers.push_back(std::move(done.history.total));
  planes.numbers.push_back(std::move(done.history.spread));
  for (Plane<float>* plane : {&done.diagnostics.frames, &done.diagnostics.surfaces, &done.diagnostics.gain})
    planes.numbers.push_back(std::move(*plane));
  return planes;
}

void add_gathers(std::vector<Pass>& passes) {
  const auto add = [&](const std::string& name, const auto& set, bool marks = true) {
    GatherParameters p;
    p.reach = 2, p.gain = false, p.change_limit = 0;
    set(p);
    Pass pass{"gather " + name, [p, marks](const RawShot& shot, Workers& w) { return gather_all(shot, p, marks, w); }};
    pass.support = p.gain ? p.gain_window + 4 : 4;
    pass.constant = true;
    // Which of two surfaces lies in front, and which of two samples is nearest, may be ties.
    pass.mirror = 1e-4, pass.mirror_share = 0.02;
    passes.push_back(pass);
  };
  add("plain", [](auto&) {});
  add(
      "without marks", [](auto&) {}, false);
  for (const int cells : {1, 8}) add("cells " + std::to_string(cells), [&](auto& p) { p.cells = cells; });
  for (const double sigma : {0.01, 2.0}) add("sigma " + std::to_string(sigma), [&](auto& p) { p.sigma = sigma; });
  for (const Word<SampleFilter>& filter : kSampleFilters)
    add("filter " + std::string(filter.word), [&](auto& p) { p.filter = filter.value; });
  add("change limit", [](auto& p) { p.change_limit = 2.5; });
  add("fireflies", [](auto& p) { p.firefly_limit = 6; });
  add("gain", [](auto& p) { p.gain = true, p.gain_window = 5; });
  add("gain window as large as the picture", [](auto& p) { p.gain = true, p.gain_window = 127; });
  add("reach 0", [](auto& p) { p.reach = 0; });
}

/// The frames of the shot as layers of one, the first in front.
std::vector<Present> layers_of(const RawShot& shot, Workers& w) {
  std::vector<Present> layers = presents_of(shot, w);
  for (Present& layer : layers) hold_opacity(layer, w);
  return layers;
}

void add_layers(std::vector<Pass>& passes) {
  for (const LayerRule rule : {LayerRule::variation, LayerRule::contribution}) {
    const std::string word = rule == LayerRule::variation ? "variation" : "contribution";
    passes.push_back({"composite_presents " + word,
                      [rule](const RawShot& shot, Workers& w) {
                        const std::vector<Present> layers = layers_of(shot, w);
                        Planes planes;
                        if (layers.empty()) return planes;
                        Present out =
                            composite_presents(pointers(layers), layers.front().color.window(), rule, true, w);
                        Plane<glm::vec4> inner(out.color.window());
                        each_pixel(inner.window(), [&](int x, int y) { inner.at(x, y) = out.color.at(x, y); });
                        planes.colors.push_back(std::move(inner));
                        planes.numbers.push_back(std::move(out.combined.winner));
                        planes.numbers.push_back(std::move(out.combined.variation));
                        return planes;
                      },
                      1, true, false});
  }
  passes.push_back({"composite_resolved",
                    [](const RawShot& shot, Workers& w) {
                      std::vector<Present> layers = layers_of(shot, w);
                      std::vector<Accumulated> done;
                      const RecursiveParameters recursive;
                      const RectifyParameters rectify;
                      for (Present& layer : layers) {
                        carry_transmittance(layer, w);
                        const History h = accumulate(layer, {}, recursive, rectify, {}, 1, {}, w).history;
                        done.push_back(accumulate(layer, h, recursive, rectify, {}, 1, {true, true, true}, w));
                        hold_resolved(done.back().history.color, layer, w);
                      }
                      std::vector<const Accumulated*> results;
                      for (const Accumulated& a : done) results.push_back(&a);
                      const std::vector<const Present*> list = pointers(layers);
                      const Present composite =
                          composite_presents(list, layers.front().color.window(), LayerRule::variation, true, w);
                      Accumulated out = composite_resolved(list, results, composite, w);
                      Planes planes;
                      planes.colors.push_back(std::move(out.history.color));
                      return planes;
                    },
                    4, true, false});
  // What a mirror's tie may choose is a whole layer.
  for (std::size_t i = passes.size() - 3; i < passes.size(); ++i) passes[i].mirror_share = 0.02;
}

void add_samples(std::vector<Pass>& passes) {
  for (const Word<SampleFilter>& filter : kSampleFilters) {
    Pass pass{"resolve_samples " + std::string(filter.word), [filter](const RawShot& shot, Workers& w) {
                const std::vector<Present> samples = presents_of(shot, w);
                Present out = resolve_samples(pointers(samples), filter.value, w, true);
                Planes planes;
                Plane<glm::vec4> inner(out.color.window());
                each_pixel(inner.window(), [&](int x, int y) { inner.at(x, y) = out.color.at(x, y); });
                planes.colors.push_back(std::move(inner));
                planes.numbers.push_back(std::move(out.sample_weight));
                return planes;
              }};
    pass.constant = filter.value == SampleFilter::none;
    passes.push_back(pass);
  }
  passes.push_back({"mean_of_results", [](const RawShot& shot, Workers& w) {
                      std::vector<Accumulated> done;
                      for (const Present& p : presents_of(shot, w))
                        done.push_back(accumulate(p, {}, {}, {}, {}, 1, {true, true, true}, w));
                      std::vector<const Accumulated*> results;
                      for (const Accumulated& a : done) results.push_back(&a);
                      Accumulated out = mean_of_results(results, w);
                      Planes planes;
                      planes.colors.push_back(std::move(out.history.color));
                      planes.numbers.push_back(std::move(out.history.total));
                      return planes;
                    }});
}

/// Every pixel of the frames as a deep pixel of points and volumes.
Planes flatten_all(const RawShot& shot, bool colored, LayerRule rule) {
  Planes planes;
  const Window& w = shot.front().window();
  Plane<glm::vec4> color(w);
  Plane<float> winner(w);
  FlattenScratch scratch;
  DeepDefects defects;
  each_pixel(w, [&](int x, int y) {
    std::vector<DeepSample> samples;
    for (std::size_t i = 0; i < shot.size(); ++i) {
      DeepSample s;
      const glm::vec4& c = shot[i].color.at(x, y);
      s.front = double(shot[i].depth.at(x, y));
      s.back = i % 2 ? s.front + 1.5 : s.front;
      s.color = glm::dvec4(c);
      // What is not finite is the reader's to mend, pixel by pixel.
      for (int k = 0; k < 4; ++k)
        if (!std::isfinite(s.color[k])) s.color[k] = 0;
      s.opacity = glm::dvec4(colored ? s.color.a * 0.5 : s.color.a, s.color.a, s.color.a, s.color.a);
      s.index = std::uint32_t(i);
      if (repair(s, defects)) samples.push_back(s);
    }
    color.at(x, y) = glm::vec4(0);
    winner.at(x, y) = -1;
    if (samples.empty()) return;
    const FlatPixel flat = flatten(samples, colored, rule, scratch);
    // Sums near the end of the floats are held by the writer of planes.
    for (int k = 0; k < 4; ++k) color.at(x, y)[k] = float(std::min(3.4e38, std::max(-3.4e38, flat.color[k])));
    winner.at(x, y) = float(flat.winner);
  });
  planes.colors.push_back(std::move(color));
  planes.numbers.push_back(std::move(winner));
  return planes;
}

void add_deep(std::vector<Pass>& passes) {
  for (const bool colored : {false, true})
    for (const LayerRule rule : {LayerRule::variation, LayerRule::contribution})
      passes.push_back({std::string("flatten deep ") + (colored ? "colored " : "gray ") +
                            (rule == LayerRule::variation ? "variation" : "contribution"),
                        [colored, rule](const RawShot& shot, Workers&) { return flatten_all(shot, colored, rule); }, 0,
                        true, false});
}

}  // namespace

std::vector<Pass> combining_passes() {
  std::vector<Pass> passes;
  add_gathers(passes);
  add_layers(passes);
  add_samples(passes);
  add_deep(passes);
  return passes;
}

}  // namespace varve::stability
