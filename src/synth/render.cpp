#include "synth/render.h"

#include <cmath>

#include "synth/hash.h"

namespace varve::synth {
namespace {

std::uint64_t pixel_key(std::uint64_t key, int x, int y) {
  return mix(mix(key, std::uint64_t(std::int64_t(x))), std::uint64_t(std::int64_t(y)));
}

// Log-normal: never negative, mean 1.
double noise_factor(double deviation, std::uint64_t key) {
  if (!(deviation > 0)) return 1;
  const double variance = std::log1p(deviation * deviation);
  return std::exp(std::sqrt(variance) * normal(mix(key, 77)) - 0.5 * variance);
}

void set_pixel(Picture& picture, int x, int y, const Sample& sample, double factor) {
  picture.r.at(x, y) = float(sample.color.r * factor);
  picture.g.at(x, y) = float(sample.color.g * factor);
  picture.b.at(x, y) = float(sample.color.b * factor);
  picture.a.at(x, y) = float(sample.alpha);
  picture.depth.at(x, y) = float(sample.depth);
  picture.backward_x.at(x, y) = float(sample.backward.x);
  picture.backward_y.at(x, y) = float(sample.backward.y);
  picture.forward_x.at(x, y) = float(sample.forward.x);
  picture.forward_y.at(x, y) = float(sample.forward.y);
  picture.id.at(x, y) = sample.id;
}

// The random places are drawn in lines of cells: x and y from halves of one key.
glm::dvec4 stratified_pixel(const Moment& moment, const FilterPositions& position, int n, std::uint64_t key, int x,
                            int y) {
  glm::dvec4 sum{0};
  const double cell = 1.0 / n;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::uint64_t random = mix(key, std::uint64_t(j) * std::uint64_t(n) + std::uint64_t(i));
      const double dx = position((i + double(random >> 32) * 0x1p-32) * cell),
                   dy = position((j + double(random & 0xFFFFFFFFu) * 0x1p-32) * cell);
      const Sample sample = evaluate_color(moment, x + 0.5 + dx, y + 0.5 + dy);
      sum += glm::dvec4(sample.color, sample.alpha);
    }
  return sum * (cell * cell);
}

}  // namespace

Picture render_samples(const Moment& moment, const Window& window, const SampleSettings& settings, Workers& workers) {
  Picture p{Plane<float>(window), Plane<float>(window),        Plane<float>(window), Plane<float>(window),
            Plane<float>(window), Plane<float>(window),        Plane<float>(window), Plane<float>(window),
            Plane<float>(window), Plane<std::uint32_t>(window)};
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const std::uint64_t key = pixel_key(settings.key, x, y);
      const Sample sample = evaluate(moment, x + 0.5 + settings.jitter.x, y + 0.5 + settings.jitter.y, key);
      set_pixel(p, x, y, sample, noise_factor(settings.noise, key));
    }
  });
  return p;
}

Truth render_stratified(const Moment& moment, const Window& window, int n, Filter filter, std::uint64_t key,
                        Workers& workers) {
  Truth truth{Plane<float>(window), Plane<float>(window), Plane<float>(window), Plane<float>(window)};
  const FilterPositions position(filter);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const glm::dvec4 mean = stratified_pixel(moment, position, n, pixel_key(key, x, y), x, y);
      truth.r.at(x, y) = float(mean.r);
      truth.g.at(x, y) = float(mean.g);
      truth.b.at(x, y) = float(mean.b);
      truth.a.at(x, y) = float(mean.a);
    }
  });
  return truth;
}

}  // namespace varve::synth
