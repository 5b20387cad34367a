#include "stability/soak.h"

#include <cmath>
#include <random>

#include "plan/preset.h"
#include "reference/accumulate_reference.h"

namespace varve::stability {
namespace {

/// Noise over an edge; new in each frame.
void paint(RawFrame& frame, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  each_pixel(frame.window(), [&](int x, int y) {
    const float base = (x + y) % 5 < 2 ? 4.0f : 0.3f;
    frame.color.at(x, y) = {base * (0.5f + unit(random)), base * (0.5f + unit(random)), base * unit(random), 1};
  });
}

glm::vec2 vector_of(Sway sway, int frame) {
  if (sway == Sway::rest) return glm::vec2(0.0f);
  const glm::vec2 v(0.37f, -0.21f);
  return sway == Sway::pan || frame % 2 ? v : -v;
}

/// Frames of the twin that follow each other.
struct Twin {
  reference::ExactHistory now, next;
  explicit Twin(const Window& w) {
    for (reference::ExactHistory* h : {&now, &next})
      h->color = Plane<glm::dvec4>(w), h->total = Plane<double>(w), h->spread = Plane<double>(w);
  }
  void step(const Present& present, const History& stored, const Settings& s, const glm::dvec2& jitter) {
    each_pixel(present.color.window(), [&](int x, int y) {
      const reference::Pixel p = reference::accumulate_pixel(present, stored, s.recursive, s.rectify, jitter, 1, x, y,
                                                             stored.empty() ? nullptr : &now);
      next.color.at(x, y) = {p.color[0], p.color[1], p.color[2], p.color[3]};
      next.total.at(x, y) = std::min(p.total, 1e6);
      next.spread.at(x, y) = p.spread;
    });
    std::swap(now, next);
  }
};

double difference(const History& history, const Twin& twin) {
  double worst = 0;
  each_pixel(history.color.window(), [&](int x, int y) {
    const glm::dvec4 slow = twin.now.color.at(x, y);
    const double size = std::max({std::abs(slow.r), std::abs(slow.g), std::abs(slow.b), std::abs(slow.a)});
    for (int k = 0; k < 4; ++k) {
      const double d = std::abs(double(history.color.at(x, y)[k]) - slow[k]) / size;
      worst = d <= worst ? worst : d;  // NaN counts
    }
  });
  return worst;
}

}  // namespace

const char* name_of(Sway sway) { return sway == Sway::rest ? "at rest" : sway == Sway::sway ? "to and fro" : "panned"; }

Soaked soak(const std::string& name, const Settings& s, Sway sway, int frames, Workers& workers) {
  Soaked soaked{name + ", " + name_of(sway), frames, 0, 0, 0};
  const Window w{0, 0, 9, 7};
  std::mt19937 random(50);
  RawFrame frame = std::move(base_shot(w, Moves::rest, 1, 51).front());
  History history;
  Twin twin(w);
  for (int f = 0; f < frames; ++f) {
    paint(frame, random);
    frame.backward.fill(vector_of(sway, f));
    frame.jitter = {0.4 * std::sin(f * 1.3), 0.4 * std::cos(f * 0.7)};
    const Present present = present_of(frame, workers);
    twin.step(present, history, s, frame.jitter);
    history = accumulate(present, history, s.recursive, s.rectify, frame.jitter, 1, {}, workers).history;
    const double d = difference(history, twin);
    soaked.worst = d <= soaked.worst ? soaked.worst : d;
    if (f >= frames - frames / 10) soaked.at_end = d <= soaked.at_end ? soaked.at_end : d;
  }
  // A step of float in each frame, forgotten by alpha; the sharp filters and the clip pass on a little more than that.
  // Where a box clips, its one way for all channels costs more now and then (twins.cpp), and is forgotten as well.
  soaked.bound = s.rectify.box == Box::none ? 16 * 6e-8 / std::max(0.01, s.recursive.alpha) : 5e-4;
  return soaked;
}

std::vector<SoakCase> soak_cases() {
  std::vector<SoakCase> cases;
  for (const Preset& preset : presets()) {
    const Parameters p = preset_parameters(preset);
    if (p.accumulator != Accumulator::recursive) continue;
    Settings s{p.recursive, p.rectify};
    s.recursive.unjitter = Unjitter::none;  // nothing that is carried on: it has a twin of its own
    cases.push_back({std::string(preset.name), s});
  }
  for (const double alpha : {0.02, 0.5}) {
    Settings s;
    s.recursive.alpha = alpha;
    s.rectify.box = Box::none;
    cases.push_back({"no box, alpha " + std::to_string(alpha).substr(0, 4), s});
    s.recursive.history_filter = HistoryFilter::bilinear;
    s.recursive.alpha_rule = AlphaRule::fixed;
    cases.push_back({"bilinear, no box, fixed alpha " + std::to_string(alpha).substr(0, 4), s});
  }
  return cases;
}

Soaked soak_mean(int frames, Workers& workers) {
  Soaked soaked{"mean of all frames at rest", frames, 0, 0, 1e-6};
  const Window w{0, 0, 3, 2};
  RawFrame frame = std::move(base_shot(w, Moves::rest, 1, 52).front());
  std::mt19937 random(53);
  Settings s;
  s.recursive.alpha = 1e-6;
  s.rectify.box = Box::none;
  Present present = present_of(frame, workers);
  std::vector<double> sum(w.pixels() * 4, 0.0);
  History history;
  for (int f = 0; f < frames; ++f) {
    paint(frame, random);
    std::size_t i = 0;
    each_pixel(w, [&](int x, int y) {
      present.color.at(x, y) = frame.color.at(x, y);
      for (int k = 0; k < 4; ++k) sum[i++] += double(frame.color.at(x, y)[k]);
    });
    history = accumulate(present, history, s.recursive, s.rectify, {}, 1, {}, workers).history;
    if (f % 100 != 99 && f != frames - 1) continue;
    i = 0;
    each_pixel(w, [&](int x, int y) {
      for (int k = 0; k < 4; ++k, ++i) {
        const double mean = sum[i] / (f + 1);
        const double d = std::abs(double(history.color.at(x, y)[k]) - mean) / mean;
        soaked.worst = d <= soaked.worst ? soaked.worst : d;
        if (f == frames - 1) soaked.at_end = d <= soaked.at_end ? soaked.at_end : d;
      }
    });
  }
  return soaked;
}

Soaked soak_small_alpha(int frames, Workers& workers) {
  Soaked soaked{"fixed alpha 1e-6 at rest", frames, 0, 0, 1e-6};
  const Window w{0, 0, 3, 2};
  Settings s;
  s.recursive.alpha = 1e-6, s.recursive.alpha_rule = AlphaRule::fixed;
  s.rectify.box = Box::none;
  RawFrame frame = std::move(base_shot(w, Moves::rest, 1, 54).front());
  frame.color.fill(glm::vec4(1));
  History history = accumulate(present_of(frame, workers), {}, s.recursive, s.rectify, {}, 1, {}, workers).history;
  frame.color.fill(glm::vec4(2));
  const Present present = present_of(frame, workers);
  double exact = 1;
  for (int f = 0; f < frames; ++f) {
    history = accumulate(present, history, s.recursive, s.rectify, {}, 1, {}, workers).history;
    exact += (2 - exact) * 1e-6;
    const double d = std::abs(double(history.color.at(1, 1).g) - exact) / exact;
    soaked.worst = d <= soaked.worst ? soaked.worst : d;
    soaked.at_end = d;
  }
  return soaked;
}

}  // namespace varve::stability
