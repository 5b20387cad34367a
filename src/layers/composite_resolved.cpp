#include <array>
#include <utility>

#include "base/held_float.h"
#include "layers/composite.h"
#include "layers/over.h"
#include "layers/transmittance.h"

namespace varve {
namespace {

/// Whose numbers a pixel shows: the winner's; the last layer's that has data there where the background won.
int shown_layer(std::span<const Present* const> presents, const Present& composite, int x, int y) {
  const int winner = int(composite.combined.winner.at(x, y)) - 1;
  if (winner >= 0) return winner;
  for (int k = int(presents.size()) - 1; k >= 0; --k)
    if (presents[std::size_t(k)]->color.window().contains(x, y)) return k;
  return -1;
}

template <class T>
void select(Plane<T>& to, std::span<const Plane<T>* const> from, const Plane<float>& shown, Workers& workers) {
  bool any = false;
  for (const Plane<T>* plane : from) any = any || !plane->empty();
  if (!any) return;
  const Window& w = shown.window();
  to = Plane<T>(w, 0, T(0));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const int k = int(shown.at(x, y));
      if (k >= 0 && !from[std::size_t(k)]->empty()) to.at(x, y) = from[std::size_t(k)]->at(x, y);
    }
  });
}

}  // namespace

Plane<glm::vec4> composite_colors(std::span<const LayerColor> layers, const Window& window, Workers& workers) {
  Plane<glm::vec4> out(window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = window.x0; x < window.x1; ++x) {
      Over over;
      for (const LayerColor& layer : layers) {
        if (!layer.color->window().contains(x, y)) continue;
        const glm::vec4& c = layer.color->at(x, y);
        glm::dvec3 t(held(1 - double(c.w)));
        if (layer.transmittance) {
          const glm::vec4& rgb = layer.transmittance->at(x, y);
          t = {held(double(rgb.x)), held(double(rgb.y)), held(double(rgb.z))};
        }
        over.add({double(c.x), double(c.y), double(c.z)}, t);
      }
      out.at(x, y) = held_color(over.color());
    }
  });
  return out;
}

Accumulated composite_resolved(std::span<const Present* const> presents, std::span<const Accumulated* const> layers,
                               const Present& composite, Workers& workers) {
  const Window& w = composite.color.window();
  Plane<float> shown(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) shown.at(x, y) = float(shown_layer(presents, composite, x, y));
  });
  const auto show = [&]<class T>(auto of, Plane<T>& to) {
    std::vector<const Plane<T>*> planes;
    for (const Accumulated* layer : layers) planes.push_back(&of(*layer));
    select<T>(to, planes, shown, workers);
  };
  Accumulated out;
  std::vector<LayerColor> colors;
  for (std::size_t k = 0; k < layers.size(); ++k) colors.push_back(layer_color(*presents[k], layers[k]->history));
  out.history.color = composite_colors(colors, w, workers);
  show(
      [](const Accumulated& a) -> auto& { return a.history.total; }, out.history.total);
  show(
      [](const Accumulated& a) -> auto& { return a.history.spread; }, out.history.spread);
  using D = AccumulateDiagnostics;
  for (Plane<float> D::*plane : {&D::clip, &D::weight, &D::count_past, &D::count_future, &D::variance, &D::frames,
                                 &D::surfaces, &D::gain, &D::removed, &D::round_trip, &D::blur, &D::residual})
    show(
        [plane](const Accumulated& a) -> auto& { return a.diagnostics.*plane; }, out.diagnostics.*plane);
  for (Plane<std::uint32_t> D::*plane : {&D::reject, &D::reject_future})
    show(
        [plane](const Accumulated& a) -> auto& { return a.diagnostics.*plane; }, out.diagnostics.*plane);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const std::vector<Plane<glm::vec4>>& companions = layers[k]->history.companions;
    const std::size_t own = companions.size() - (presents[k]->transmittance.empty() ? 0 : 1);
    for (std::size_t i = 0; i < own; ++i) out.history.companions.push_back(companions[i].clone());
  }
  return out;
}

LayerColor layer_color(const Present& present, const History& history) {
  const bool apart = !present.transmittance.empty() && !history.companions.empty();
  return {&history.color, apart ? &history.companions.back() : nullptr};
}

void carry_transmittance(Present& layer, Workers& workers) {
  if (layer.transmittance.empty()) return;
  const Window& w = layer.transmittance.window();
  Plane<glm::vec4> carried(w, kPresentBorder, glm::vec4(0.0f));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) carried.at(x, y) = glm::vec4(layer.transmittance.at(x, y), 0.0f);
  });
  layer.companion_is_color.resize(layer.companions.size(), 1);
  layer.companions.push_back(std::move(carried));
  layer.companion_is_color.push_back(0);
}

}  // namespace varve
