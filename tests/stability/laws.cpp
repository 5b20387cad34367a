#include "stability/laws.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace varve::stability {
namespace {

/// Calls f(name, a, b, value index) for every value of two results until it says something.
template <class F>
std::string each_value(const Planes& a, const Planes& b, const F& f) {
  if (a.colors.size() != b.colors.size() || a.numbers.size() != b.numbers.size()) return "other planes";
  const auto look = [&](const auto& one, const auto& other, std::size_t index, const char* kind, int values) {
    const Window& w = one.window();
    if (!(w == other.window())) return std::string("another window");
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x)
        for (int k = 0; k < values; ++k) {
          const float u = reinterpret_cast<const float*>(&one.at(x, y))[k];
          const float v = reinterpret_cast<const float*>(&other.at(x, y))[k];
          if (f(u, v, x, y, k, values)) continue;
          std::ostringstream text;
          text << kind << " plane " << index << " at " << x << "," << y << " channel " << k << ": " << u << " and "
               << v;
          return text.str();
        }
    return std::string();
  };
  for (std::size_t i = 0; i < a.colors.size(); ++i)
    if (std::string broken = look(a.colors[i], b.colors[i], i, "color", 4); !broken.empty()) return broken;
  for (std::size_t i = 0; i < a.numbers.size(); ++i)
    if (std::string broken = look(a.numbers[i], b.numbers[i], i, "number", 1); !broken.empty()) return broken;
  return "";
}

Planes run(const Pass& pass, const RawShot& shot, Workers& workers, LawCounts& counts) {
  ++counts.runs;
  for (const RawFrame& frame : shot) counts.pixels += long(frame.window().pixels());
  return pass.run(shot, workers);
}

bool same_float(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0 || a == b; }

}  // namespace

std::string broken_finite(const Pass& pass, const RawShot& shot, Workers& workers, LawCounts& counts) {
  const Planes out = run(pass, shot, workers, counts);
  return each_value(out, out, [](float u, float, int, int, int, int) { return std::isfinite(u); });
}

std::string broken_footprint(const Pass& pass, bool moves, Workers& workers, LawCounts& counts) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  // History is read up to 2 pixels farther each frame where it lies between pixels.
  const auto support = [&](std::size_t frame) { return pass.support + (moves ? 3 * int(2 - frame) + 4 : 0); };
  const int at_x = 10, at_y = 8;
  const Window w{0, 0, at_x + support(0) + 12, 16};
  const RawShot clean = base_shot(w, moves ? Moves::pan : Moves::rest, 3, 17);
  const Planes a = run(pass, clean, workers, counts);
  struct Bad {
    std::size_t frame;
    glm::vec4 color;
  };
  for (const Bad& bad :
       {Bad{0, {0, nan, 0, 0}}, Bad{1, {inf, 0, -inf, nan}}, Bad{2, {1e30f, 0, -3, 0}}, Bad{1, {65504, 0, 0, 0}}}) {
    RawShot hurt = clone(clean);
    for (int k = 0; k < 4; ++k)
      if (bad.color[k] != 0) hurt[bad.frame].color.at(at_x, at_y)[k] = bad.color[k];
    const int reach = support(bad.frame);
    const std::string broken =
        each_value(a, run(pass, hurt, workers, counts), [&](float u, float v, int x, int y, int, int) {
          return (std::abs(x - at_x) <= reach && std::abs(y - at_y) <= reach) || same_float(u, v);
        });
    if (broken.empty()) continue;
    return broken + " though more than " + std::to_string(reach) + " px from a bad pixel of frame " +
           std::to_string(bad.frame);
  }
  return "";
}

std::string broken_scale(const Pass& pass, int exponent, Workers& workers, LawCounts& counts) {
  const RawShot plain = base_shot({-3, 2, 26, 19}, Moves::any, 3, 18, true);
  const float factor = std::ldexp(1.0f, exponent);
  const Planes a = run(pass, plain, workers, counts), b = run(pass, scaled(plain, factor), workers, counts);
  return each_value(a, b, [&](float u, float v, int, int, int k, int values) {
    return same_float(values == 4 && k < 3 ? u * factor : u, v);
  });
}

std::string broken_mirror(const Pass& pass, bool vertical, Workers& workers, LawCounts& counts) {
  const RawShot plain = base_shot({-2, 3, 30, 35}, Moves::any, 3, 19, true);
  const Planes a = run(pass, plain, workers, counts);
  Planes b = run(pass, mirrored(plain, vertical), workers, counts);
  const Window& w = plain.front().window();
  const auto turned = [&](int x, int y) {
    return vertical ? glm::ivec2(x, w.y0 + w.y1 - 1 - y) : glm::ivec2(w.x0 + w.x1 - 1 - x, y);
  };
  std::string first;
  long values = 0, apart = 0;
  for (std::size_t i = 0; i < a.colors.size(); ++i)
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const glm::ivec2 t = turned(x, y);
        const glm::vec4 u = a.colors[i].at(x, y), v = b.colors[i].at(t.x, t.y);
        double size = 1e-30;
        for (int k = 0; k < 4; ++k) size = std::max(size, std::abs(double(u[k])));
        for (int k = 0; k < 4; ++k, ++values) {
          if (std::abs(double(u[k]) - double(v[k])) <= pass.mirror * size) continue;
          ++apart;
          std::ostringstream text;
          text << "color plane " << i << " at " << x << "," << y << " channel " << k << ": " << u[k] << " and " << v[k];
          if (first.empty()) first = text.str();
        }
      }
  if (double(apart) <= pass.mirror_share * double(values)) return "";
  return first + ", and " + std::to_string(apart) + " of " + std::to_string(values) + " values in all";
}

std::string broken_constancy(const Pass& pass, const glm::vec4& color, Workers& workers, LawCounts& counts) {
  const RawShot shot = constant(base_shot({-3, 2, 22, 15}, Moves::any, 3, 20, true), color);
  const Planes out = run(pass, shot, workers, counts);
  return each_value(
      out, out, [&](float u, float, int, int, int k, int values) { return values != 4 || same_float(u, color[k]); });
}

std::string broken_threads(const Pass& pass, LawCounts& counts) {
  const RawShot shot = base_shot({-3, 2, 68, 43}, Moves::any, 3, 22, true);
  Workers one(1), two(2), five(5);
  const Planes a = run(pass, shot, one, counts);
  for (Workers* workers : {&two, &five}) {
    const Planes b = run(pass, shot, *workers, counts);
    const std::string broken =
        each_value(a, b, [](float u, float v, int, int, int, int) { return std::memcmp(&u, &v, sizeof u) == 0; });
    if (!broken.empty()) return broken + " with " + std::to_string(workers->count()) + " threads";
  }
  return "";
}

}  // namespace varve::stability
