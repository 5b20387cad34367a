// Small presents and histories for the laws: noise with edges, highlights, bad pixels, moving windows.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "resolve/accumulate.h"

namespace varve::test {

struct NoiseOptions {
  unsigned seed = 1;
  double bad_share = 0;   ///< of pixels that are NaN or infinite
  double motion = 3;      ///< px, largest part of a vector
  double bad_motion = 0;  ///< share of NaN vectors
  bool with_depth = false;
  float scale = 1;
  bool with_marks = false;  ///< ids, normals and both masks
};

/// Three objects in slanted bands, each turned its own way but for the noise, some of it unknown; masks at random.
inline void add_marks(Present& p, std::mt19937& random) {
  const Window& w = p.color.window();
  std::uniform_real_distribution<float> unit(0, 1);
  p.id = Plane<std::uint32_t>(w);
  p.normal = Plane<glm::vec3>(w);
  p.reactive = Plane<float>(w);
  p.responsive = Plane<float>(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const int object = (x + 2 * y + 1000) % 13 / 5;
      p.id.at(x, y) = std::uint32_t(object) * 4294967u;
      const double angle = object * 0.9 + 0.2 * double(unit(random));
      p.normal.at(x, y) =
          unit(random) < 0.05f ? glm::vec3(0.0f) : glm::vec3(float(std::cos(angle)), float(std::sin(angle)), 0.0f);
      p.reactive.at(x, y) = unit(random) < 0.5f ? 0.0f : unit(random);
      p.responsive.at(x, y) = 2 * unit(random);
    }
}

/// Two-tone noise with an occasional highlight; vectors at random; sanitized.
inline Present noise_present(const Window& w, const NoiseOptions& o, Workers& workers) {
  std::mt19937 random(o.seed);
  std::uniform_real_distribution<float> unit(0, 1);
  Present p;
  p.color = Plane<glm::vec4>(w, kPresentBorder);
  p.motion = Plane<glm::vec2>(w);
  if (o.with_depth) p.depth = Plane<float>(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const bool edge = (x + 2 * y) % 13 < 6;
      const float base = (edge ? 0.8f : 0.05f) * o.scale;
      const float peak = unit(random) < 0.01f ? 200.0f : 1.0f;
      glm::vec4 c(base * (0.8f + 0.4f * unit(random)) * peak, base * (0.6f + 0.4f * unit(random)) * peak,
                  base * unit(random) * peak, edge ? 1.0f : unit(random));
      if (double(unit(random)) < o.bad_share)
        c[int(unit(random) * 3.99f)] =
            unit(random) < 0.5f ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
      p.color.at(x, y) = c;
      const float m = float(o.motion);
      glm::vec2 v((unit(random) * 2 - 1) * m, (unit(random) * 2 - 1) * m);
      if (unit(random) < 0.1f) v = glm::vec2(std::round(v.x), std::round(v.y));
      if (double(unit(random)) < o.bad_motion) v = glm::vec2(std::numeric_limits<float>::quiet_NaN());
      p.motion.at(x, y) = v;
      if (o.with_depth)
        p.depth.at(x, y) =
            edge ? 5.0f + 0.1f * unit(random) : (unit(random) < 0.2f ? std::numeric_limits<float>::infinity() : 9.0f);
    }
  if (o.with_marks) add_marks(p, random);
  sanitize(p, workers);
  return p;
}

/// A present of one color at rest.
inline Present flat_present(const Window& w, const glm::vec4& color, Workers& workers) {
  Present p;
  p.color = Plane<glm::vec4>(w, kPresentBorder, color);
  sanitize(p, workers);
  return p;
}

inline History next_history(const Present& present, const History& previous, const RecursiveParameters& recursive,
                            const RectifyParameters& rectify, Workers& workers) {
  return accumulate(present, previous, recursive, rectify, {}, 1, {}, workers).history;
}

inline bool same_bits(const Plane<glm::vec4>& a, const Plane<glm::vec4>& b) {
  if (!(a.window() == b.window())) return false;
  for (int y = a.window().y0; y < a.window().y1; ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(glm::vec4) * std::size_t(a.window().width())) != 0) return false;
  return true;
}

}  // namespace varve::test
