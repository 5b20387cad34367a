#include "stability/shots.h"

#include <Imath/half.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace varve::stability {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr float kDenormal = std::numeric_limits<float>::denorm_min();

using Random = std::mt19937;
float unit(Random& random) { return std::uniform_real_distribution<float>(0, 1)(random); }

/// About one pixel in six takes a value in one channel.
RawShot with_values(const Window& window, const std::vector<float>& values) {
  RawShot shot = base_shot(window, Moves::any, 3, 7, true);
  Random random(11);
  for (RawFrame& frame : shot)
    each_pixel(window, [&](int x, int y) {
      if (unit(random) < 0.17f) frame.color.at(x, y)[int(random() % 4)] = values[random() % values.size()];
    });
  return shot;
}

/// A flat patch as a renderer's half leaves it.
RawShot flat_noise(const Window& window, float level) {
  RawShot shot = base_shot(window, Moves::any, 3, 5);
  Random random(3);
  for (RawFrame& frame : shot)
    each_pixel(window, [&](int x, int y) {
      for (int k = 0; k < 3; ++k) frame.color.at(x, y)[k] = float(half(level * (1 + 0.002f * (unit(random) - 0.5f))));
    });
  return shot;
}

RawShot with_depths(const Window& window, const std::vector<float>& values) {
  RawShot shot = base_shot(window, Moves::any, 3, 8, true);
  Random random(12);
  for (RawFrame& frame : shot)
    each_pixel(window, [&](int x, int y) { frame.depth.at(x, y) = values[random() % values.size()]; });
  return shot;
}

RawShot with_vectors(const Window& window, const std::vector<float>& values, float share) {
  RawShot shot = base_shot(window, Moves::any, 3, 9, true);
  Random random(13);
  const auto pick = [&] { return values[random() % values.size()]; };
  for (RawFrame& frame : shot)
    each_pixel(window, [&](int x, int y) {
      if (unit(random) < share) frame.backward.at(x, y) = {pick(), pick()};
      if (unit(random) < share) frame.forward.at(x, y) = {pick(), pick()};
    });
  return shot;
}

RawShot alternating_vectors(const Window& window) {
  RawShot shot = base_shot(window, Moves::rest, 3, 10);
  int turn = 0;
  for (RawFrame& frame : shot) {
    const float sign = ++turn % 2 ? 1.0f : -1.0f;
    each_pixel(window, [&](int x, int y) {
      const float here = (x + y) % 2 ? sign : -sign;
      frame.backward.at(x, y) = {7.25f * here, -3.5f * here};
      frame.forward.at(x, y) = {-7.25f * here, 3.5f * here};
    });
  }
  return shot;
}

RawShot checkered(const Window& window, float one, float other) {
  RawShot shot = base_shot(window, Moves::any, 3, 14);
  int turn = 0;
  for (RawFrame& frame : shot) {
    ++turn;
    each_pixel(window, [&](int x, int y) {
      const float value = (x + y + turn) % 2 ? one : other;
      frame.color.at(x, y) = {value, -value, value, 0.5f};
    });
  }
  return shot;
}

RawShot with_masks(const Window& window, float reactive, float responsive) {
  RawShot shot = base_shot(window, Moves::any, 3, 15, true);
  for (RawFrame& frame : shot) frame.reactive.fill(reactive), frame.responsive.fill(responsive);
  return shot;
}

Present present_with(const RawFrame& frame, const Plane<glm::vec2>& vectors, Workers& workers) {
  const Window& w = frame.window();
  Present p;
  p.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(kNan));  // the border is the pass's to fill
  each_pixel(w, [&](int x, int y) { p.color.at(x, y) = frame.color.at(x, y); });
  const auto decoded = [&](const Plane<glm::vec2>& stored) {
    Plane<float> vx(w), vy(w);
    each_pixel(w, [&](int x, int y) { vx.at(x, y) = stored.at(x, y).x, vy.at(x, y) = stored.at(x, y).y; });
    std::size_t unusable = 0;
    return decode_motion(vx, vy, {}, w, MotionParameters().max_length, workers, unusable);
  };
  if (!vectors.empty()) p.motion = decoded(vectors);
  if (!frame.forward.empty()) p.forward = decoded(frame.forward);
  if (!frame.depth.empty()) {
    p.depth = frame.depth.clone();
    canonical_depth(p.depth, DepthKind::distance, 1e10, workers);
  }
  if (!frame.id.empty()) p.id = frame.id.clone();
  if (!frame.normal.empty()) p.normal = frame.normal.clone();
  if (!frame.reactive.empty()) p.reactive = frame.reactive.clone();
  if (!frame.responsive.empty()) p.responsive = frame.responsive.clone();
  p.jitter = frame.jitter;
  return p;
}

}  // namespace

RawShot clone(const RawShot& shot) {
  RawShot copy;
  for (const RawFrame& f : shot)
    copy.push_back({f.color.clone(), f.backward.clone(), f.forward.clone(), f.depth.clone(), f.id.clone(),
                    f.normal.clone(), f.reactive.clone(), f.responsive.clone(), f.jitter});
  return copy;
}

Present present_of(const RawFrame& frame, Workers& workers, bool companions) {
  Present p = present_with(frame, frame.backward, workers);
  if (companions) {
    const Window& w = frame.window();
    for (int k = 0; k < 3; ++k) p.companions.emplace_back(w, kPresentBorder);
    p.companion_is_color = {1, 1, 0};
    each_pixel(w, [&](int x, int y) {
      const glm::vec4& c = frame.color.at(x, y);
      p.companions[0].at(x, y) = c / 3.0f;
      p.companions[1].at(x, y) = c - c / 3.0f;
      p.companions[2].at(x, y) = glm::vec4(c.g, c.r, 1 - c.b, c.a);
    });
  }
  sanitize(p, workers);
  sanitize_companions(p, workers);
  return p;
}

Present turned_present(const RawFrame& frame, Workers& workers) {
  Present p = present_with(frame, frame.forward, workers);
  sanitize(p, workers);
  return p;
}

RawShot base_shot(const Window& window, Moves moves, int frames, unsigned seed, bool masks) {
  RawShot shot;
  Random random(seed);
  const glm::vec2 pan(0.63f, -0.29f);
  for (int f = 0; f < frames; ++f) {
    RawFrame frame;
    frame.color = Plane<glm::vec4>(window);
    frame.backward = Plane<glm::vec2>(window), frame.forward = Plane<glm::vec2>(window);
    frame.depth = Plane<float>(window);
    frame.id = Plane<std::uint32_t>(window);
    frame.normal = Plane<glm::vec3>(window);
    if (masks) frame.reactive = Plane<float>(window), frame.responsive = Plane<float>(window);
    frame.jitter = {0.31 - 0.2 * (f % 3), -0.22 + 0.25 * (f % 3)};
    each_pixel(window, [&](int x, int y) {
      const int object = ((x - window.x0) + 2 * (y - window.y0)) % 13 / 5;
      const float base = object == 1 ? 0.8f : 0.05f, peak = unit(random) < 0.01f ? 200.0f : 1.0f;
      frame.color.at(x, y) = {base * (0.8f + 0.4f * unit(random)) * peak, base * (0.6f + 0.4f * unit(random)) * peak,
                              base * unit(random) * peak, object == 1 ? 1.0f : unit(random)};
      glm::vec2 v(0), on(0);
      if (moves == Moves::pan) v = pan, on = -pan;
      if (moves == Moves::any) v = {6 * unit(random) - 3, 6 * unit(random) - 3}, on = -v + 0.2f * unit(random);
      frame.backward.at(x, y) = v, frame.forward.at(x, y) = on;
      frame.depth.at(x, y) = object == 1 ? 5 + 0.1f * unit(random) : object == 2 ? kInf : 9 + unit(random);
      frame.id.at(x, y) = std::uint32_t(object) * 4294967u + 1;
      const double angle = object * 0.9 + 0.2 * double(unit(random));
      frame.normal.at(x, y) = {float(std::cos(angle)), float(std::sin(angle)), 0.0f};
      if (masks) {
        frame.reactive.at(x, y) = unit(random) < 0.5f ? 0.0f : unit(random);
        frame.responsive.at(x, y) = 2 * unit(random);
      }
    });
    shot.push_back(std::move(frame));
  }
  return shot;
}

std::vector<Extreme> extremes() {
  const auto values = [](std::vector<float> v) { return [v](const Window& w) { return with_values(w, v); }; };
  const auto depths = [](std::vector<float> v) { return [v](const Window& w) { return with_depths(w, v); }; };
  const auto vectors = [](std::vector<float> v, float share) {
    return [v, share](const Window& w) { return with_vectors(w, v, share); };
  };
  const auto flat = [](float level) { return [level](const Window& w) { return flat_noise(w, level); }; };
  return {
      {"values NaN", values({kNan, -kNan})},
      {"values infinite", values({kInf, -kInf})},
      {"values minus zero", values({-0.0f})},
      {"values denormal", values({kDenormal, -kDenormal, 1e-40f, 5e-39f})},
      {"values negative", values({-1, -0.25f, -65504})},
      {"values 65504", values({65504})},
      {"values 1e30", values({1e30f, -1e30f})},
      {"values 1e-30", values({1e-30f})},
      {"values at the end of float", values({3.4028235e38f, -3.4028235e38f})},
      {"values of all kinds", values({kNan, kInf, -0.0f, kDenormal, -1, 65504, 1e30f, 1e-30f})},
      {"nothing but NaN", [](const Window& w) { return constant(base_shot(w, Moves::any), glm::vec4(kNan)); }},
      {"black", [](const Window& w) { return constant(base_shot(w, Moves::any), glm::vec4(0)); }},
      {"flat 1", flat(1)},
      {"flat 1000", flat(1000)},
      {"flat 60000", flat(60000)},
      {"checker of the ends of float", [](const Window& w) { return checkered(w, 3.4028235e38f, -3.4028235e38f); }},
      {"checker of 65504 and 1e-30", [](const Window& w) { return checkered(w, 65504, 1e-30f); }},
      {"depth 0", depths({0, 5})},
      {"depth infinite", depths({kInf, 5})},
      {"depth 1e10", depths({1e10f, 5})},
      {"depth reversed", depths({0, 0.1f, 0.2f, 1e-10f, 1e-30f})},
      {"depth of all kinds", depths({kNan, kInf, -kInf, -5, 0, kDenormal, 3.4e38f, 5})},
      {"vectors NaN", vectors({kNan}, 0.5f)},
      {"vectors infinite", vectors({kInf, -kInf}, 0.5f)},
      {"vectors of 1e6 px", vectors({1e6f, -1e6f, 0}, 0.7f)},
      {"vectors of 1e38 px", vectors({1e38f, -1e38f}, 0.7f)},
      {"vectors tiny", vectors({kDenormal, -1e-30f, 1e-7f}, 0.8f)},
      {"vectors to the very edge", vectors({-0.5f, 0.5f, -6, 6, 12.5f}, 0.8f)},
      {"vectors alternating", alternating_vectors},
      {"masks 0", [](const Window& w) { return with_masks(w, 0, 0); }},
      {"masks full", [](const Window& w) { return with_masks(w, 1, 1e6f); }},
  };
}

std::vector<Window> awkward_windows(bool wide) {
  std::vector<Window> windows = {{0, 0, 0, 0},  {4, 4, 4, 9}, {0, 0, 1, 1}, {-7, 3, -6, 4}, {0, 0, 1, 17},
                                 {0, 0, 19, 1}, {0, 0, 2, 2}, {0, 0, 3, 5}, {-5, -9, 8, 2}, {1, 1, 32, 18}};
  if (wide)
    for (const int rows : {1, 2, 3}) windows.push_back({0, 0, 16384, rows});
  return windows;
}

RawShot all_halves() {
  RawShot shot = base_shot({0, 0, 256, 256}, Moves::any, 3, 21);
  for (RawFrame& frame : shot)
    each_pixel(frame.window(), [&](int x, int y) {
      const unsigned bits = unsigned(y) * 256 + unsigned(x);
      for (unsigned k = 0; k < 4; ++k) {
        half value;
        value.setBits(static_cast<unsigned short>((bits * (2 * k + 1) + 977 * k) & 0xFFFFu));
        frame.color.at(x, y)[int(k)] = float(value);
      }
    });
  return shot;
}

RawShot mirrored(const RawShot& shot, bool vertical) {
  RawShot out = clone(shot);
  const glm::vec2 turn = vertical ? glm::vec2(1, -1) : glm::vec2(-1, 1);
  for (std::size_t f = 0; f < shot.size(); ++f) {
    const RawFrame& from = shot[f];
    RawFrame& to = out[f];
    const Window& w = from.window();
    const auto copy = [&](const auto& a, auto& b) {
      if (a.empty()) return;
      each_pixel(w, [&](int x, int y) {
        b.at(x, y) = a.at(vertical ? x : w.x0 + w.x1 - 1 - x, vertical ? w.y0 + w.y1 - 1 - y : y);
      });
    };
    copy(from.color, to.color), copy(from.backward, to.backward), copy(from.forward, to.forward);
    copy(from.depth, to.depth), copy(from.id, to.id), copy(from.normal, to.normal);
    copy(from.reactive, to.reactive), copy(from.responsive, to.responsive);
    to.jitter = from.jitter * glm::dvec2(turn);
    each_pixel(w, [&](int x, int y) {
      to.backward.at(x, y) *= turn, to.forward.at(x, y) *= turn;
      to.normal.at(x, y) *= glm::vec3(turn, 1);
    });
  }
  return out;
}

RawShot scaled(const RawShot& shot, float factor) {
  RawShot out = clone(shot);
  for (RawFrame& frame : out)
    each_pixel(frame.window(), [&](int x, int y) {
      for (int k = 0; k < 3; ++k) frame.color.at(x, y)[k] *= factor;
    });
  return out;
}

RawShot constant(const RawShot& shot, const glm::vec4& color) {
  RawShot out = clone(shot);
  for (RawFrame& frame : out) frame.color.fill(color);
  return out;
}

}  // namespace varve::stability
