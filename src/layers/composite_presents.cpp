#include <algorithm>
#include <limits>
#include <utility>

#include "base/held_float.h"
#include "layers/composite.h"
#include "layers/over.h"
#include "layers/transmittance.h"

namespace varve {
namespace {

using Layers = std::span<const Present* const>;

Window window_of(Layers layers, Window window) {
  for (const Present* layer : layers) window = unite(window, layer->color.window());
  return window;
}

template <class Has>
bool any(Layers layers, Has has) {
  return std::any_of(layers.begin(), layers.end(), [&](const Present* layer) { return has(*layer); });
}

/// The planes that some layer has, with what stands where nothing is known.
Present make_present(Layers layers, const Window& w, bool show) {
  Present p;
  p.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0.0f));
  p.valid = Plane<float>(w, kPresentBorder, 0.0f);
  p.rows_valid.assign(std::size_t(w.height()), 0);
  p.jitter = layers.front()->jitter;
  if (any(layers, [](const Present& l) { return !l.motion.empty(); })) p.motion = Plane<glm::vec2>(w);
  if (any(layers, [](const Present& l) { return !l.forward.empty(); })) p.forward = Plane<glm::vec2>(w);
  if (any(layers, [](const Present& l) { return !l.depth.empty(); })) p.depth = Plane<float>(w);
  if (any(layers, [](const Present& l) { return !l.id.empty(); })) p.id = Plane<std::uint32_t>(w);
  if (any(layers, [](const Present& l) { return !l.normal.empty(); })) p.normal = Plane<glm::vec3>(w);
  if (any(layers, [](const Present& l) { return !l.reactive.empty(); })) p.reactive = Plane<float>(w);
  if (any(layers, [](const Present& l) { return !l.responsive.empty(); })) p.responsive = Plane<float>(w);
  if (show)
    for (Plane<float>* plane : {&p.combined.winner, &p.combined.variation, &p.combined.touched})
      *plane = Plane<float>(w);
  for (const Present* layer : layers) {
    p.not_finite += layer->not_finite;
    p.opacity_held += layer->opacity_held;
    p.companions_not_finite += layer->companions_not_finite;
    for (std::size_t i = 0; i < layer->companions.size(); ++i) {
      p.companions.emplace_back(w, kPresentBorder, glm::vec4(0.0f));
      const bool listed = i < layer->companion_is_color.size();
      p.companion_is_color.push_back(listed ? layer->companion_is_color[i] : std::uint8_t(1));
    }
  }
  return p;
}

/// Who a pixel follows.
struct Winner {
  int layer = -1;  ///< -1: the background
  double variation = 0, contribution = 0;
};

/// The background, what lies behind the last layer, competes with what reaches it. Ties go to the front.
struct Contest {
  LayerRule rule;
  Winner most;      // by variation
  Winner lightest;  // by contribution

  void enter(int layer, const Over::Change& change) {
    if (change.variation > most.variation) most = {layer, change.variation, change.contribution};
    if (change.contribution > lightest.contribution) lightest = {layer, change.variation, change.contribution};
  }
  Winner winner(double left) const {
    if (rule == LayerRule::contribution && lightest.layer >= 0) return lightest;
    return left > most.variation ? Winner{-1, left, 0} : most;
  }
};

template <class T>
T taken(const Plane<T>& plane, const T& missing, int x, int y) {
  return plane.empty() ? missing : plane.at(x, y);
}

/// The surface that the pixel follows lends all that is known of it. The background is what the last layer's file holds
/// where it has no coverage: renderers write the camera's motion there, or none.
void follow(Present& out, const Present& from, bool background, int x, int y) {
  const glm::vec2 unknown(std::numeric_limits<float>::quiet_NaN()), rest(0.0f);
  const bool rests = from.motion.empty() && from.forward.empty();  // a layer without vectors is at rest
  if (!out.motion.empty()) out.motion.at(x, y) = taken(from.motion, rests ? rest : unknown, x, y);
  if (!out.forward.empty()) out.forward.at(x, y) = taken(from.forward, rests ? rest : unknown, x, y);
  const float far = std::numeric_limits<float>::infinity();
  if (!out.depth.empty()) out.depth.at(x, y) = background ? far : taken(from.depth, far, x, y);
  if (!out.id.empty()) out.id.at(x, y) = background ? 0u : taken(from.id, 0u, x, y);
  if (!out.normal.empty())
    out.normal.at(x, y) = background ? glm::vec3(0.0f) : taken(from.normal, glm::vec3(0.0f), x, y);
  if (!out.reactive.empty()) out.reactive.at(x, y) = taken(from.reactive, 0.0f, x, y);
  if (!out.responsive.empty()) out.responsive.at(x, y) = taken(from.responsive, 1.0f, x, y);
}

/// Where no layer has data.
void follow_nothing(Present& out, int x, int y) { follow(out, Present(), true, x, y); }

void composite_pixel(Layers layers, LayerRule rule, Present& out, int x, int y) {
  Over over;
  Contest contest{rule, {}, {}};
  bool valid = true;
  int touched = 0;
  const Present* last = nullptr;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const Present& layer = *layers[k];
    if (!layer.color.window().contains(x, y)) continue;
    last = &layer;
    const glm::vec4& color = layer.color.at(x, y);
    const glm::dvec3 c(double(color.x), double(color.y), double(color.z)), t = transmittance_at(layer, x, y);
    if (c == glm::dvec3(0.0) && t == glm::dvec3(1.0)) continue;
    const Over::Change change = over.add(c, t);
    contest.enter(int(k), change);
    if (!(change.variation > 0) && change.contribution == 0) continue;  // hidden
    valid = valid && layer.valid.at(x, y) > 0;
    ++touched;
  }
  const glm::dvec4 color = over.color();
  out.color.at(x, y) = held_color(color);
  out.valid.at(x, y) = valid ? 1.0f : 0.0f;
  const Winner winner = contest.winner(luminance(over.transmittance()));
  if (!last)
    follow_nothing(out, x, y);
  else
    follow(out, winner.layer < 0 ? *last : *layers[std::size_t(winner.layer)], winner.layer < 0, x, y);
  if (out.combined.winner.empty()) return;
  out.combined.winner.at(x, y) = float(winner.layer + 1);
  out.combined.variation.at(x, y) = float(winner.variation);
  out.combined.touched.at(x, y) = float(touched);
}

void copy_companions(Layers layers, Present& out, int y) {
  std::size_t to = 0;
  for (const Present* layer : layers)
    for (const Plane<glm::vec4>& companion : layer->companions) {
      const Window& w = companion.window();
      Plane<glm::vec4>& plane = out.companions[to++];
      if (y >= w.y0 && y < w.y1) std::copy_n(companion.row(y), w.width(), &plane.at(w.x0, y));
    }
}

}  // namespace

Present composite_presents(Layers layers, const Window& at_least, LayerRule rule, bool show, Workers& workers) {
  const Window w = window_of(layers, at_least);
  Present out = make_present(layers, w, show);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) composite_pixel(layers, rule, out, x, y);
    copy_companions(layers, out, y);
    const float* valid = out.valid.row(y);
    out.rows_valid[std::size_t(y - w.y0)] = std::all_of(valid, valid + w.width(), [](float v) { return v > 0; });
  });
  return out;
}

}  // namespace varve
