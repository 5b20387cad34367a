#include "stages/trade_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace varve {
namespace {

constexpr float kLeft = 62, kTop = 34, kPlotWidth = 440, kPlotHeight = 340, kBottom = 46, kLegendLine = 16;
constexpr Ink kInk(0.13f), kGrid(0.88f), kFloor(0.45f), kDot(0.55f, 0.6f, 0.68f), kFront(0.07f, 0.36f, 0.72f),
    kBest(0.85f, 0.33f, 0.05f);

std::string decimal(double value, int digits) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// An axis with round numbers on it.
struct Axis {
  double low = 0, high = 1, step = 1;
  int digits = 0;
  Axis(double least, double greatest) {
    const double span = std::max(greatest - least, std::max(1e-3, 1e-3 * std::abs(greatest)));
    const double raw = span / 5, power = std::pow(10, std::floor(std::log10(raw)));
    step = power * (raw / power <= 1 ? 1 : raw / power <= 2 ? 2 : raw / power <= 5 ? 5 : 10);
    low = step * std::floor(least / step - 0.2);
    high = step * std::ceil(greatest / step + 0.2);
    digits = std::max(0, -int(std::floor(std::log10(step) + 1e-9)));
  }
  float place(double value) const { return float((value - low) / (high - low)); }
};

struct Place {
  Axis x, y;
  glm::vec2 operator()(double ms, double decibels) const {
    return {kLeft + kPlotWidth * x.place(ms), kTop + kPlotHeight * (1 - y.place(decibels))};
  }
};

double score_of(const Measurement& m, const SettingFigures& f) { return m.with_reference ? f.psnr_tone : f.leave_out; }

void draw_axes(Drawing& d, const Place& place, const Measurement& m) {
  const float bottom = kTop + kPlotHeight, right = kLeft + kPlotWidth;
  for (double v = place.x.low; v <= place.x.high + 1e-9; v += place.x.step) {
    const float x = place(v, place.y.low).x;
    d.lines.push_back({{x, kTop}, {x, bottom}, kGrid});
    d.texts.push_back({{x, bottom + 12}, decimal(v, place.x.digits), kInk, Anchor::middle});
  }
  for (double v = place.y.low; v <= place.y.high + 1e-9; v += place.y.step) {
    const float y = place(place.x.low, v).y;
    d.lines.push_back({{kLeft, y}, {right, y}, kGrid});
    d.texts.push_back({{kLeft - 6, y}, decimal(v, place.y.digits), kInk, Anchor::end});
  }
  d.lines.push_back({{kLeft, bottom}, {right, bottom}, kInk});
  d.lines.push_back({{kLeft, kTop}, {kLeft, bottom}, kInk});
  d.texts.push_back(
      {{kLeft + kPlotWidth / 2, bottom + 32}, "time, ms per frame (left is faster)", kInk, Anchor::middle});
  d.texts.push_back({{14, kTop + kPlotHeight / 2},
                     m.with_reference ? "PSNR (tone) to reference, dB" : "left-out score, dB: ranks only",
                     kInk,
                     Anchor::middle,
                     true});
}

/// Numbers beside their dots, moved where another one or a dot stands.
void draw_numbers(Drawing& d) {
  constexpr std::array<glm::vec2, 8> around = {glm::vec2{12, -9}, {12, 9}, {-12, -9}, {-12, 9},
                                               {0, -13},          {0, 13}, {16, 0},   {-16, 0}};
  std::vector<glm::vec2> taken;
  for (const Drawing::Dot& dot : d.dots) taken.push_back(dot.center);
  const std::size_t dots = d.dots.size();
  for (std::size_t i = 0; i < dots; ++i) {
    glm::vec2 best = d.dots[i].center + around[0];
    float most = -1;
    for (glm::vec2 offset : around) {
      const glm::vec2 at = d.dots[i].center + offset;
      float clear = 1e9f;
      for (glm::vec2 other : taken)
        clear = std::min(clear, std::max(std::abs(at.x - other.x) / 20, std::abs(at.y - other.y) / 13));
      clear = std::min(clear, 1.0f);  // enough is enough: the first that fits
      if (clear > most + 1e-3f) most = clear, best = at;
    }
    taken.push_back(best);
    const std::string title = d.dots[i].title;
    d.texts.push_back({best, title.substr(0, title.find(' ')), kInk, Anchor::middle});
  }
}

void draw_front(Drawing& d, const Place& place, const Measurement& m) {
  std::vector<const SettingFigures*> front;
  for (const SettingFigures& f : m.settings)
    if (f.on_front) front.push_back(&f);
  std::ranges::sort(front, {}, &SettingFigures::seconds);
  for (std::size_t i = 0; i + 1 < front.size(); ++i)
    d.lines.push_back({place(1e3 * front[i]->seconds, score_of(m, *front[i])),
                       place(1e3 * front[i + 1]->seconds, score_of(m, *front[i + 1])), kFront, 2});
}

}  // namespace

Drawing trade_plot(const Measurement& m) {
  double slowest = m.floor_seconds, worst = INFINITY, best = -INFINITY;
  std::size_t longest = 20;
  for (const SettingFigures& f : m.settings) {
    longest = std::max(longest, f.name.size() + 4);
    if (!std::isfinite(score_of(m, f))) continue;
    slowest = std::max(slowest, f.seconds);
    worst = std::min(worst, score_of(m, f));
    best = std::max(best, score_of(m, f));
  }
  if (worst > best) worst = best = 0;
  const Place place{Axis(1e3 * m.floor_seconds, 1e3 * slowest), Axis(worst, best)};

  Drawing d;
  const float legend = kLeft + kPlotWidth + 24;
  d.width = int(legend + 8 * float(longest)) + 16;
  d.height = int(std::max(kTop + kPlotHeight + kBottom, kTop + kLegendLine * float(m.settings.size() + 3) + 10));
  draw_axes(d, place, m);
  const float floor = place(1e3 * m.floor_seconds, 0).x;
  d.lines.push_back({{floor, kTop}, {floor, kTop + kPlotHeight}, kFloor, 1.5f, true});
  d.texts.push_back({{floor, kTop - 10}, "read + write only", kFloor, Anchor::start});
  draw_front(d, place, m);
  d.texts.push_back({{legend, kTop - 10}, "blue: Pareto front", kFront});
  d.texts.push_back({{legend, kTop - 10 + kLegendLine}, "orange: recommended", kBest});
  for (std::size_t i = 0; i < m.settings.size(); ++i) {
    const SettingFigures& f = m.settings[i];
    const Ink ink = m.recommended == i ? kBest : f.on_front ? kFront : kDot;
    const std::string title = std::to_string(i + 1) + " " + f.name;
    d.texts.push_back(
        {{legend, kTop - 10 + kLegendLine * float(i + 3)}, title, m.recommended == i || f.on_front ? ink : kInk});
    if (std::isfinite(score_of(m, f)))
      d.dots.push_back({place(1e3 * f.seconds, score_of(m, f)), m.recommended == i ? 5.5f : 4.5f, ink, title});
  }
  draw_numbers(d);
  return d;
}

}  // namespace varve
