#include "reference/layers_reference.h"

#include <algorithm>
#include <array>
#include <vector>

namespace varve::reference {
namespace {

using Number = long double;
using Rgb = std::array<Number, 3>;

Number luma(const Rgb& v) {
  if (v[0] == v[1] && v[1] == v[2]) return v[0];
  return 0.2126L * v[0] + 0.7152L * v[1] + 0.0722L * v[2];
}

Rgb let_through(const Present& layer, int x, int y) {
  Rgb t;
  for (int k = 0; k < 3; ++k) {
    t[std::size_t(k)] =
        layer.transmittance.empty() ? 1.0L - Number(layer.color.at(x, y).w) : Number(layer.transmittance.at(x, y)[k]);
    t[std::size_t(k)] = std::clamp(t[std::size_t(k)], 0.0L, 1.0L);
  }
  return t;
}

}  // namespace

StackedPixel stacked_pixel(std::span<const Present* const> layers, LayerRule rule, int x, int y) {
  std::vector<Rgb> arriving = {{1, 1, 1}}, light;  // in front of layer k, and what it adds
  for (const Present* layer : layers) {
    Rgb t = {1, 1, 1}, c = {0, 0, 0};
    if (layer->color.window().contains(x, y)) {
      t = let_through(*layer, x, y);
      for (int k = 0; k < 3; ++k) c[std::size_t(k)] = Number(layer->color.at(x, y)[k]);
    }
    Rgb part, left;
    for (std::size_t k = 0; k < 3; ++k) {
      part[k] = arriving.back()[k] * c[k];
      left[k] = arriving.back()[k] * t[k];
    }
    light.push_back(part);
    arriving.push_back(left);
  }
  StackedPixel pixel;
  for (const Rgb& part : light)
    for (int k = 0; k < 3; ++k) pixel.color[k] += double(part[std::size_t(k)]);
  pixel.color.w = double(1.0L - luma(arriving.back()));
  const auto change = [&](std::size_t k) {
    Rgb c;
    for (std::size_t i = 0; i < 3; ++i) c[i] = arriving[k][i] - arriving[k + 1][i];
    return luma(c);
  };
  // By light where there is any; else, and by default, by transmittance, and there the background competes.
  const bool lit = std::any_of(light.begin(), light.end(), [](const Rgb& c) { return luma(c) > 0; });
  const bool by_light = rule == LayerRule::contribution && lit;
  Number most = 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const Number by = by_light ? luma(light[k]) : change(k);
    if (by > most) most = by, pixel.winner = int(k + 1), pixel.variation = double(change(k));
    pixel.touched += change(k) > 0 || luma(light[k]) != 0;
  }
  if (!by_light && luma(arriving.back()) > most) pixel.winner = 0, pixel.variation = double(luma(arriving.back()));
  return pixel;
}

}  // namespace varve::reference
