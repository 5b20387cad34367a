#include "synth/texture.h"

#include <algorithm>
#include <cmath>

#include "synth/hash.h"

namespace varve::synth {
namespace {

constexpr double kPi = 3.141592653589793;

glm::dvec3 blend(const glm::dvec3& a, const glm::dvec3& b, double t) { return a + (b - a) * t; }

// Position in a cell of size 1, and the cell.
struct Cell {
  double i, j, x, y;
};
Cell cell_of(double u, double v) {
  const double i = std::floor(u), j = std::floor(v);
  return {i, j, u - i, v - j};
}

glm::dvec3 bricks(const Texture& t, double u, double v) {
  const double rows = v / (0.45 * t.size);
  const double shift = 0.5 * (std::int64_t(std::floor(rows)) & 1);
  const Cell c = cell_of(u / t.size + shift, rows);
  if (c.x < 0.06 || c.y < 0.13) return t.second;
  const double tone = 0.45 + 0.55 * uniform(cell_key(c.i, c.j, t.seed));
  const double grain = 0.85 + 0.15 * uniform(cell_key(std::floor(u * 1.6), std::floor(v * 1.6), t.seed + 1));
  return t.first * (tone * grain);
}

// 0.5 + 0.5 cos: the local frequency is proportional to the radius.
glm::dvec3 zone_plate(const Texture& t, double u, double v) {
  return blend(t.second, t.first, 0.5 + 0.5 * std::cos(kPi * (u * u + v * v) / (2 * t.size)));
}

glm::dvec3 spots(const Texture& t, double u, double v) {
  const Cell c = cell_of(u / t.size, v / t.size);
  const std::uint64_t key = cell_key(c.i, c.j, t.seed);
  const double x = c.x - (0.35 + 0.3 * uniform(mix(key, 1))), y = c.y - (0.35 + 0.3 * uniform(mix(key, 2)));
  const double radius = 0.15 + 0.18 * uniform(mix(key, 3));
  return x * x + y * y < radius * radius ? t.second : t.first;
}

double lattice_noise(double u, double v, std::uint64_t seed) {
  const Cell c = cell_of(u, v);
  const auto corner = [&](int di, int dj) { return uniform(cell_key(c.i + di, c.j + dj, seed)); };
  const double x = c.x * c.x * (3 - 2 * c.x), y = c.y * c.y * (3 - 2 * c.y);
  const double top = corner(0, 0) * (1 - x) + corner(1, 0) * x, low = corner(0, 1) * (1 - x) + corner(1, 1) * x;
  return top * (1 - y) + low * y;
}

glm::dvec3 value_noise(const Texture& t, double u, double v) {
  double sum = 0, weight = 0.5, scale = 1 / t.size;
  for (int octave = 0; octave < 4; ++octave, weight *= 0.6, scale *= 2)
    sum += weight * lattice_noise(u * scale, v * scale, t.seed + std::uint64_t(octave));
  return blend(t.second, t.first, std::clamp(2.4 * sum / 1.088 - 0.7, 0.0, 1.0));
}

// Small square lamps; each cell is twice as bright as the one before it, up to `first`.
glm::dvec3 emitters(const Texture& t, double u, double v) {
  const Cell c = cell_of(u / t.size, v / t.size);
  const bool lamp = std::abs(c.x - 0.5) < 0.1 && std::abs(c.y - 0.5) < 0.1;
  const double stops = std::fmod(std::fmod(c.i + 7 * c.j, 17) + 17, 17);
  return lamp ? t.first * std::exp2(-stops) : t.second;
}

}  // namespace

glm::dvec3 texture_color(const Texture& t, double u, double v) {
  switch (t.pattern) {
    case Pattern::checker: {
      const std::int64_t parity = std::int64_t(std::floor(u / t.size)) + std::int64_t(std::floor(v / t.size));
      return (parity & 1) ? t.second : t.first;
    }
    case Pattern::stripes:
      return (std::int64_t(std::floor(u / t.size)) & 1) ? t.second : t.first;
    case Pattern::grid: {
      const Cell c = cell_of(u / t.size, v / t.size);
      return c.x < 0.12 || c.y < 0.12 ? t.second : t.first;
    }
    case Pattern::bricks:
      return bricks(t, u, v);
    case Pattern::zone_plate:
      return zone_plate(t, u, v);
    case Pattern::spots:
      return spots(t, u, v);
    case Pattern::value_noise:
      return value_noise(t, u, v);
    case Pattern::emitters:
      return emitters(t, u, v);
    case Pattern::plain:
      break;
  }
  return t.first;
}

}  // namespace varve::synth
