#include <cmath>
#include <random>

#include "diagnose/color_error.h"
#include "motion/dilate.h"
#include "plan/knob_words.h"
#include "reference/accumulate_reference.h"
#include "resolve/window_moments.h"
#include "stability/twins_parts.h"

namespace varve::stability {
namespace {

/// A picture as the windows see it: one value in all channels.
struct Picture {
  int edge;
  std::vector<float> color, weight;
  template <class F>
  Picture(int size, const F& value) : edge(size) {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        color.insert(color.end(), 4, value(x, y));
        weight.push_back(1);
      }
  }
  long double at(int x, int y) const { return color[std::size_t(4 * (y * edge + x))]; }
};

}  // namespace

void measure_motion(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers) {
  Measured& dilated = row_of(rows, "dilate_motion", words_of(inputs) + ", 3 rules, in pixels", 1e-12);
  Measured& decoded = row_of(rows, "decode_motion", words_of(inputs) + ", 3 units", 1e-7);
  Measured& canonical = row_of(rows, "canonical_depth", words_of(inputs) + ", 4 kinds", 1e-7);
  for (const Input& input : inputs)
    for (const RawFrame& raw : input.shot) {
      const Present p = present_of(raw, workers);
      for (const Word<Dilation>& dilation : kDilations)
        for (const bool apart : {false, true}) {
          ++dilated.runs;
          const DilatedMotion fast = apart ? dilate_surfaces_apart(p.motion.clone(), p.depth, dilation.value, workers)
                                           : dilate_motion(p.motion.clone(), p.depth, dilation.value, workers);
          each_pixel(kTwinWindow, [&](int x, int y) {
            const bool surfaces = apart && dilation.value == Dilation::longest;
            const glm::vec2 slow = reference::dilated_motion(p.motion, p.depth, dilation.value, x, y, surfaces);
            const glm::vec2 got = fast.motion.at(x, y);
            ++dilated.values;
            // Vectors whose squares are no floats any more are all as long as none: 1e-30 px or another.
            const double off =
                std::isnan(got.x) || std::isnan(slow.x)
                    ? double(std::isnan(got.x) != std::isnan(slow.x))
                    : std::max(std::abs(double(got.x) - double(slow.x)), std::abs(double(got.y) - double(slow.y)));
            dilated.take(off, 1, std::string(dilation.word) + ", " + input.name);
          });
        }
      Plane<float> vx(kTwinWindow), vy(kTwinWindow);
      each_pixel(kTwinWindow,
                 [&](int x, int y) { vx.at(x, y) = raw.backward.at(x, y).x, vy.at(x, y) = raw.backward.at(x, y).y; });
      for (const MotionUnit unit : {MotionUnit::pixel, MotionUnit::unit, MotionUnit::ndc}) {
        ++decoded.runs;
        MotionEncoding e;
        e.bias = 0.1, e.scale = 0.7, e.shutter = 0.5, e.sign_y = -1, e.unit = unit;
        std::size_t unusable = 0;
        const Plane<glm::vec2> fast = decode_motion(vx, vy, e, kTwinWindow, 16384, workers, unusable);
        each_pixel(kTwinWindow, [&](int x, int y) {
          const auto to_px = [&](float v, double sign, int edge) {
            const long double whole = unit == MotionUnit::pixel ? 1 : unit == MotionUnit::unit ? edge : edge / 2.0L;
            return static_cast<long double>(sign) * (static_cast<long double>(v) - 0.1L) * 0.7L / 0.5L * whole;
          };
          const long double sx = to_px(vx.at(x, y), 1, kTwinWindow.width()),
                            sy = to_px(vy.at(x, y), -1, kTwinWindow.height());
          const bool usable = std::sqrt(sx * sx + sy * sy) <= 16384;
          const glm::vec2 got = fast.at(x, y);
          ++decoded.values;
          const double length = double(std::sqrt(sx * sx + sy * sy));
          if (usable == std::isnan(got.x))
            decoded.take(std::abs(length - 16384) < 1e-3 ? 0 : 1, 1, input.name);
          else if (usable)
            decoded.take(std::max(std::abs(double(got.x) - double(sx)), std::abs(double(got.y) - double(sy))),
                         std::max(length, 0.1), input.name);
        });
      }
      for (const Word<DepthKind>& kind : kDepthKinds) {
        ++canonical.runs;
        Plane<float> fast = raw.depth.clone();
        canonical_depth(fast, kind.value, 1e10, workers);
        each_pixel(kTwinWindow, [&](int x, int y) {
          const double stored = double(raw.depth.at(x, y));
          const double z = kind.value == DepthKind::negative  ? -stored
                           : kind.value == DepthKind::inverse ? 1 / stored
                                                              : stored;
          const bool surface = z > 0 && z < 1e10;
          const float got = fast.at(x, y);
          ++canonical.values;
          const bool agrees = surface ? std::abs(double(got) - z) <= 1e-7 * z + 1.5e-45 : std::isinf(got) && got > 0;
          // One over a float may round across the limit.
          canonical.take(agrees || std::abs(z - 1e10) < 1e4 ? 0 : 1, 1, std::string(kind.word) + ", " + input.name);
        });
      }
    }
}

void measure_moments(bool thorough, std::vector<Measured>& rows, Workers& workers) {
  Measured& row = row_of(rows, "window moments", "stripes and corners of 65504, 1e30 beside 1, noise of 1e-6", 1e-9);
  std::mt19937 random(4);
  std::normal_distribution<float> normal(0, 1);
  const int edge = 40;
  const std::vector<std::pair<std::string, Picture>> pictures = {
      {"65504 beside .001",
       Picture(edge, [&](int x, int) { return x < 9 ? 65504.0f : 1e-3f * (1 + 0.1f * normal(random)); })},
      {"65504 in the corner",
       Picture(edge, [&](int x, int y) { return x < 4 && y < 4 ? 65504.0f : 1e-8f * normal(random); })},
      {"1e4 +- .01", Picture(edge, [&](int, int) { return 1e4f + 1e-2f * normal(random); })},
      {"1e30 above 1", Picture(edge, [&](int, int y) { return y < 7 ? 1e30f : 1 + 0.1f * normal(random); })},
      {"denormals", Picture(edge, [&](int, int) { return 1e-40f * normal(random); })}};
  const std::vector<int> windows = thorough ? std::vector<int>{3, 5, 15, 31, 63} : std::vector<int>{3, 15};
  for (const auto& [name, picture] : pictures)
    for (const int window : windows) {
      ++row.runs;
      AccumulateView v{};
      v.width = v.height = edge;
      v.neighbors = {picture.color.data(), 4 * edge}, v.weight = {picture.weight.data(), edge};
      WindowBand<Moments> band;
      gather_band(v, window, slid_widths(window, WindowMoments::separable), 0, edge, band, workers);
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x, ++row.values) {
          long double n = 0, mean = 0, m2 = 0;
          const auto each = [&](const auto& use) {
            for (int j = std::max(0, y - window / 2); j <= std::min(edge - 1, y + window / 2); ++j)
              for (int i = std::max(0, x - window / 2); i <= std::min(edge - 1, x + window / 2); ++i)
                use(picture.at(i, j));
          };
          each([&](long double c) { n += 1, mean += c; });
          mean /= n;
          each([&](long double c) { m2 += (c - mean) * (c - mean); });
          row.take(band.at(x, y).m2[0] - double(m2), double(m2), name + ", window " + std::to_string(window));
        }
    }
}

void measure_metrics(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers) {
  Measured& row = row_of(rows, "compare: mean, rmse, relmse, psnr", words_of(inputs) + " against the next frame", 1e-6);
  for (const Input& input : inputs) {
    ++row.runs;
    const auto color = [&](std::size_t f) { return input.shot[f].color.clone(); };
    const ColorPair pair = make_color_pair(color(0), color(1), false, workers);
    const ColorError fast = color_error(pair, 100, PuTable(), workers);
    long double absolute = 0, squares = 0, relative = 0, linear = 0, light = 0;
    long good = 0, all = 0;
    each_pixel(kTwinWindow, [&](int x, int y) {
      const glm::vec4& a = pair.a.at(x, y);
      light += 0.2126L * a.r + 0.7152L * a.g + 0.0722L * a.b;
    });
    light /= static_cast<long double>(kTwinWindow.pixels());
    each_pixel(kTwinWindow, [&](int x, int y) {
      for (int c = 0; c < 3; ++c, ++all) {
        if (pair.bad.at(x, y)) {
          linear += 1;
          continue;
        }
        const long double a = pair.a.at(x, y)[c], b = pair.b.at(x, y)[c], d = b - a;
        const auto held = [](long double v) { return std::clamp(v, 0.0L, 1.0L); };
        ++good;
        absolute += std::abs(d), squares += d * d;
        if (d != 0) relative += d * d / (a * a + 0.01L * light * light);
        linear += (held(b) - held(a)) * (held(b) - held(a));
      }
    });
    const auto take = [&](double value, long double slow, const char* name) {
      ++row.values;
      if (std::isnan(value) && good == 0) return;
      if (value == double(slow)) return;
      row.take(value - double(slow), std::abs(double(slow)), std::string(name) + ", " + input.name);
    };
    take(fast.mean(), absolute / good, "mean");
    take(fast.rmse(), std::sqrt(squares / good), "rmse");
    take(fast.relmse(), relative / good, "relmse");
    take(fast.psnr(), -10 * std::log10(linear / all), "psnr");
  }
}

}  // namespace varve::stability
