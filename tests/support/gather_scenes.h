// Shots for the gather: scenes known in closed form, sampled at jittered positions with exact vectors.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "gather/gather.h"
#include "gather/shading_gain.h"

namespace varve::test {

/// What a ray through a position at a time meets; its vectors lead to the frames before and after.
struct Seen {
  glm::vec4 color{0};
  std::uint32_t id = 1;
  float depth = 10;
  glm::dvec2 back{0}, on{0};
};
using World = std::function<Seen(glm::dvec2 at, int frame)>;

struct ShotOptions {
  int frames = 9;
  Window window{0, 0, 37, 29};
  glm::ivec2 window_motion{0, 0};  ///< of the data window, pixels per frame
  bool ids = true, depths = true, jitter = true;
  int companions = 0;  ///< the first has 1/3 of the color, the second the rest
  int samples = 1;     ///< in each pixel of a frame
};

/// Frames with all that the gather wants of them. Sources point into it.
struct Shot {
  std::vector<Present> presents;
  std::vector<Plane<glm::vec2>> backward, forward;
  std::vector<glm::dvec2> jitter;
  std::vector<SurfaceBlocks> blocks;
  std::vector<Plane<float>> light;
  std::vector<Plane<LightRange>> range;
  std::size_t samples = 1;

  SurfaceTest test() const { return surface_test(presents.front()); }
  /// Frame after frame, all samples of each.
  std::vector<GatherSource> sources(std::size_t begin, std::size_t end) const {
    std::vector<GatherSource> list;
    for (std::size_t i = begin * samples; i < end * samples; ++i) {
      GatherSource s;
      s.sample = i % samples;
      s.present = &presents[i];
      s.jitter = jitter[i];
      s.backward = &backward[i];
      s.forward = &forward[i];
      s.blocks = &blocks[i];
      if (!light.empty()) s.local_light = &light[i], s.light_range = &range[i];
      list.push_back(s);
    }
    return list;
  }
  std::vector<GatherSource> sources() const { return sources(0, presents.size() / samples); }
  /// The light of each frame as its own samples show it.
  void measure_light(int edge, Workers& workers) {
    light.clear(), range.clear();
    for (const Present& p : presents) {
      light.push_back(local_light(p.color, p, test(), edge, workers));
      range.push_back(local_range(p.color, p, test(), workers));
    }
  }
};

/// Radical inverse, for jitter.
inline double halton(int i, int base) {
  double f = 1, r = 0;
  for (; i > 0; i /= base) f /= base, r += f * (i % base);
  return r;
}

inline Shot take(const World& world, const ShotOptions& o, Workers& workers) {
  Shot shot;
  shot.samples = std::size_t(o.samples);
  for (int i = 0; i < o.frames * o.samples; ++i) {
    const int f = i / o.samples;
    const Window w{o.window.x0 + f * o.window_motion.x, o.window.y0 + f * o.window_motion.y,
                   o.window.x1 + f * o.window_motion.x, o.window.y1 + f * o.window_motion.y};
    const glm::dvec2 jitter = o.jitter ? glm::dvec2(halton(i + 1, 2) - 0.5, halton(i + 1, 3) - 0.5) : glm::dvec2(0);
    Present p;
    p.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0));
    for (int k = 0; k < o.companions; ++k) p.companions.emplace_back(w, kPresentBorder, glm::vec4(0));
    if (o.depths) p.depth = Plane<float>(w);
    if (o.ids) p.id = Plane<std::uint32_t>(w);
    Plane<glm::vec2> back(w), on(w);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const Seen s = world(glm::dvec2(x + 0.5, y + 0.5) + jitter, f);
        p.color.at(x, y) = s.color;
        if (o.companions > 0) p.companions[0].at(x, y) = s.color / 3.0f;
        if (o.companions > 1) p.companions[1].at(x, y) = s.color - s.color / 3.0f;
        if (o.depths) p.depth.at(x, y) = s.depth;
        if (o.ids) p.id.at(x, y) = s.id;
        back.at(x, y) = glm::vec2(s.back), on.at(x, y) = glm::vec2(s.on);
      }
    sanitize(p, workers);
    sanitize_companions(p, workers);
    shot.presents.push_back(std::move(p));
    shot.backward.push_back(std::move(back)), shot.forward.push_back(std::move(on));
    shot.jitter.push_back(jitter);
    shot.blocks.push_back(summarize_surfaces(shot.presents.back()));
  }
  return shot;
}

/// Smooth, below half a cycle a pixel, positive.
inline glm::vec4 texture(glm::dvec2 p) {
  const double a = std::sin(1.7 * p.x + 0.4 * p.y), b = std::cos(0.9 * p.y - 0.3 * p.x);
  return {float(0.5 + 0.3 * a), float(0.4 + 0.2 * b), float(0.3 + 0.1 * a * b), 1.0f};
}

/// A plane with a slanted edge that slides over another one, each with a motion of its own.
struct TwoPlanes {
  glm::dvec2 front_speed{0.63, -0.21}, back_speed{-0.4, 0.17};
  double edge = 14;
  std::function<glm::vec4(glm::dvec2)> front = texture;
  std::function<glm::vec4(glm::dvec2)> back = [](glm::dvec2 p) { return texture(p * 0.7 + 5.0) * 2.0f; };
  bool covers(glm::dvec2 at, int frame) const {
    const glm::dvec2 q = at - front_speed * double(frame);
    return q.x + 0.35 * q.y < edge;
  }
  Seen operator()(glm::dvec2 at, int frame) const {
    if (covers(at, frame)) return {front(at - front_speed * double(frame)), 7, 4, -front_speed, front_speed};
    return {back(at - back_speed * double(frame)), 3, 10, -back_speed, back_speed};
  }
};

/// All at rest.
inline World still(std::function<glm::vec4(glm::dvec2)> color) {
  return [color = std::move(color)](glm::dvec2 at, int) { return Seen{color(at), 1, 10, {}, {}}; };
}

}  // namespace varve::test
