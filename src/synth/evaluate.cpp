// What a position sees: surfaces met, sorted by depth, shaded, composited; then the ways of the first one.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "synth/hash.h"
#include "synth/moment.h"

namespace varve::synth {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kMostHits = 6;  // translucent surfaces on one ray

struct Hit {
  const PlacedSurface* placed = nullptr;
  double depth = 1e300;
  glm::dvec3 local{0};     // where on the surface
  glm::dvec2 material{0};  // the same without sway; on spheres and the sky: angle times radius, height
};

/// Hits front to back; the last one is opaque or there is none behind it.
struct Hits {
  std::array<Hit, kMostHits> rows;
  int count = 0;

  void insert(const Hit& hit) {
    int at = count < kMostHits ? count++ : kMostHits - 1;
    for (; at > 0 && rows[std::size_t(at - 1)].depth > hit.depth; --at)
      rows[std::size_t(at)] = rows[std::size_t(at - 1)];
    rows[std::size_t(at)] = hit;
  }
};

double sway_offset(const Surface& s, double v, double time) {
  if (s.sway.amplitude == 0) return 0;
  const double height = s.sway.rooted ? (s.half_height - v) / (2 * s.half_height) : 1;
  return s.sway.amplitude * height * height * std::sin(s.sway.wave * v + s.sway.speed * time);
}

bool between_bars(const Surface& s, double m) {
  const double index = std::floor(m / s.bar_pitch), from_center = m - (index + 0.5) * s.bar_pitch;
  const double width = s.bar_width * (0.75 + 0.5 * uniform(cell_key(index, 0, s.id)));
  return std::abs(from_center) * 2 > width;
}

bool meets_flat(const PlacedSurface& p, const glm::dvec3& pixel, double time, double nearest, Hit& hit) {
  const Surface& s = *p.surface;
  const glm::dvec3 q = p.to_local * pixel;
  if (!(q.z > 0 && q.z * nearest > 1)) return false;
  const double u = q.x / q.z, v = q.y / q.z, m = u - sway_offset(s, v, time);
  if (s.outline == Outline::disc) {
    if (m * m + v * v > s.half_width * s.half_width) return false;
  } else {
    if (std::abs(m) > s.half_width || std::abs(v) > s.half_height) return false;
    if (s.outline == Outline::bars && between_bars(s, m)) return false;
  }
  hit = {&p, 1 / q.z, {u, v, 0}, {m, v}};
  return true;
}

bool meets_sphere(const PlacedSurface& p, const glm::dvec3& ray, double nearest, Hit& hit) {
  const double radius = p.surface->half_width;
  const double a = glm::dot(ray, ray), b = glm::dot(ray, p.center), c = glm::dot(p.center, p.center) - radius * radius;
  const double root = b * b - a * c;
  if (!(root >= 0)) return false;
  const double depth = (b - std::sqrt(root)) / a;
  if (!(depth > 0 && depth < nearest)) return false;
  const glm::dvec3 local = p.to_local * (ray * depth - p.center);
  hit = {&p, depth, local, {std::atan2(local.x, -local.z) * radius, local.y}};
  return true;
}

bool meets_sky(const PlacedSurface& p, const glm::dvec3& pixel, double nearest, Hit& hit) {
  if (!(kFarDepth < nearest)) return false;
  const glm::dvec3 local = p.to_local * pixel;
  const double flat = std::hypot(local.x, local.z), size = p.surface->half_width;
  hit = {&p, kFarDepth, local, {std::atan2(local.x, local.z) * size, std::atan2(local.y, flat) * size}};
  return true;
}

bool meets(const PlacedSurface& p, const glm::dvec3& pixel, const glm::dvec3& ray, double time, double nearest,
           Hit& hit) {
  switch (p.surface->outline) {
    case Outline::sphere:
      return meets_sphere(p, ray, nearest, hit);
    case Outline::sky:
      return meets_sky(p, pixel, nearest, hit);
    default:
      return meets_flat(p, pixel, time, nearest, hit);
  }
}

void find_hits(const Moment& moment, const glm::dvec3& pixel, const glm::dvec3& ray,
               std::optional<std::uint64_t> chance, Hits& hits) {
  Hit nearest, hit;
  for (const PlacedSurface& p : moment.surfaces) {
    if (!(pixel.x >= p.bounds.x && pixel.y >= p.bounds.y && pixel.x <= p.bounds.z && pixel.y <= p.bounds.w)) continue;
    if (!meets(p, pixel, ray, moment.time, nearest.depth, hit)) continue;
    const Surface& s = *p.surface;
    const bool by_chance = s.stochastic && chance;
    if (by_chance && uniform(mix(*chance, s.id)) >= s.opacity) continue;
    if (s.opacity >= 1 || by_chance)
      nearest = hit;
    else
      hits.insert(hit);
  }
  while (hits.count > 0 && hits.rows[std::size_t(hits.count - 1)].depth >= nearest.depth) --hits.count;
  if (nearest.placed && hits.count < kMostHits) hits.rows[std::size_t(hits.count++)] = nearest;
}

// Unit normal in camera coordinates, towards the camera.
glm::dvec3 normal_at(const Hit& hit, const glm::dvec3& ray) {
  const Surface& s = *hit.placed->surface;
  const double k = kTwoPi / s.shine.bump_size, bump = s.shine.bump;
  glm::dvec3 n;
  if (s.outline == Outline::sphere) {
    n = hit.local / s.half_width;
    if (bump != 0)
      n += bump * glm::dvec3(std::sin(k * hit.local.x), std::sin(k * hit.local.y), std::sin(k * hit.local.z));
  } else {
    n = {0, 0, glm::dot(hit.placed->rotation[2], ray) < 0 ? 1 : -1};
    if (bump != 0) n += bump * glm::dvec3(std::sin(k * hit.material.x), std::sin(k * hit.material.y), 0);
  }
  return glm::normalize(hit.placed->rotation * n);
}

glm::dvec3 shade(const Moment& moment, const Hit& hit, const glm::dvec3& ray) {
  const Surface& s = *hit.placed->surface;
  glm::dvec3 color = texture_color(s.texture, hit.material.x, hit.material.y) * hit.placed->brightness;
  if (s.lit || s.shine.strength > 0) {
    const glm::dvec3 lamp = glm::transpose(moment.to_world) * glm::normalize(glm::dvec3(-0.45, -0.65, -0.6));
    const glm::dvec3 n = normal_at(hit, ray);
    if (s.lit) color *= 0.25 + 0.75 * std::max(0.0, glm::dot(n, lamp));
    if (s.shine.strength > 0) {
      const double mirrored = glm::dot(glm::reflect(glm::normalize(ray), n), lamp);
      if (mirrored > 0) color += s.shine.strength * std::pow(mirrored, s.shine.power);
    }
  }
  for (const PlacedSpot& spot : moment.spots) {
    const glm::dvec3 d = moment.to_world * (ray * hit.depth - spot.center) * spot.inverse_radii;
    const double rest = 1 - glm::dot(d, d);
    if (rest > 0) color *= 1 + spot.amount * rest * rest;
  }
  return color;
}

void composite(const Moment& moment, const Hits& hits, const glm::dvec3& ray, bool by_chance, Sample& sample) {
  double through = 1;
  for (int i = 0; i < hits.count; ++i) {
    const Hit& hit = hits.rows[std::size_t(i)];
    const Surface& s = *hit.placed->surface;
    const double opacity = by_chance && s.stochastic ? 1 : s.opacity;
    sample.color += shade(moment, hit, ray) * (through * opacity);
    through *= 1 - opacity;
  }
  sample.alpha = 1 - through;
}

// From here to where the same point is seen in another frame.
glm::dvec2 way(const glm::dmat3& matrix, const glm::dvec3& offset, const Hit& hit, const glm::dvec3& pixel, double time,
               double& depth) {
  glm::dvec3 local = hit.local;
  const Surface& s = *hit.placed->surface;
  if (s.sway.amplitude != 0 && s.vectors != Vectors::carrier)
    local.x = hit.material.x + sway_offset(s, hit.material.y, time);
  const glm::dvec3 there = matrix * local + offset;
  depth = there.z;
  return {there.x / there.z - pixel.x, there.y / there.z - pixel.y};
}

void set_ways(const Moment& moment, const Hits& hits, const glm::dvec3& pixel, Sample& sample) {
  int first = 0;
  while (first + 1 < hits.count && hits.rows[std::size_t(first)].placed->surface->vectors == Vectors::below) ++first;
  const Hit& hit = hits.rows[std::size_t(first)];
  const Surface& s = *hit.placed->surface;
  sample.depth = hit.depth;
  if (s.vectors == Vectors::none) {
    sample.depth_before = sample.depth_after = hit.depth;
    return;
  }
  const PlacedSurface& p = *hit.placed;
  sample.backward = way(p.before, p.before_offset, hit, pixel, moment.time - 1, sample.depth_before);
  sample.forward = way(p.after, p.after_offset, hit, pixel, moment.time + 1, sample.depth_after);
  // What rests has vectors of zero and not of rounding, so that a resolver can tell.
  if (p.rests_before) sample.backward = glm::dvec2(0);
  if (p.rests_after) sample.forward = glm::dvec2(0);
}

}  // namespace

Sample evaluate(const Moment& moment, double x, double y, std::optional<std::uint64_t> chance) {
  const glm::dvec3 pixel{x, y, 1}, ray = moment.to_ray * pixel;
  Hits hits;
  find_hits(moment, pixel, ray, chance, hits);
  Sample sample;
  if (hits.count == 0) return sample;
  composite(moment, hits, ray, chance.has_value(), sample);
  set_ways(moment, hits, pixel, sample);
  sample.surface = hits.rows[0].placed->surface;
  sample.id = sample.surface->id;
  sample.material = hits.rows[0].material;
  return sample;
}

Sample evaluate_color(const Moment& moment, double x, double y) {
  const glm::dvec3 pixel{x, y, 1}, ray = moment.to_ray * pixel;
  Hits hits;
  find_hits(moment, pixel, ray, std::nullopt, hits);
  Sample sample;
  composite(moment, hits, ray, false, sample);
  return sample;
}

}  // namespace varve::synth
