// Sampling: truth converges as stratified sampling does, filters are what they say, noise has mean 1.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <tuple>

#include "synth/hash.h"
#include "synth/render.h"
#include "synth/scenes.h"

namespace varve::synth {
namespace {

double squared_distance(const Truth& a, const Truth& b) {
  double sum = 0;
  const Window& w = a.r.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const double d = std::min(1.f, a.g.at(x, y)) - std::min(1.f, b.g.at(x, y));
      sum += d * d;
    }
  return sum / double(w.pixels());
}

TEST(SynthTruth, FourTimesTheSamplesAreAboutEightTimesNearer) {
  // Stratified samples across an edge: variance falls with n^3 (Mitchell 1996); wires and grain fall slower.
  Workers workers;
  const Window window{0, 0, 160, 90};
  const Scene scene = make_scene("quality-all");
  const Moment moment = moment_of(scene, 20, 160, 90);
  const auto render = [&](int n, std::uint64_t key) {
    return render_stratified(moment, window, n, Filter::box, key, workers);
  };
  const Truth reference = render(32, 1);
  const double two = squared_distance(render(2, 2), reference), four = squared_distance(render(4, 3), reference),
               eight = squared_distance(render(8, 4), reference);
  EXPECT_GT(two / four, 5);
  EXPECT_LT(two / four, 12);
  EXPECT_GT(four / eight, 5);
  EXPECT_LT(four / eight, 12);
}

TEST(SynthTruth, StochasticSurfacesCountWithTheirOpacity) {
  Workers workers;
  const Scene scene = make_scene("stochastic-alpha");
  const Moment moment = moment_of(scene, 5, 320, 180);
  const Window window{60, 80, 64, 84};
  const Truth truth = render_stratified(moment, window, 2, Filter::box, 1, workers);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      EXPECT_EQ(truth.a.at(x, y), 1);
      EXPECT_GE(truth.r.at(x, y), 0.5f);  // a quarter of 2
      EXPECT_LT(truth.r.at(x, y), 1.1f);
    }
}

// Deviation of a filter's weight by plain summation of its definition.
double deviation_of(const std::function<double(double)>& weight) {
  double sum = 0, squares = 0;
  for (double x = -1.5; x <= 1.5; x += 1e-4) {
    sum += weight(x);
    squares += weight(x) * x * x;
  }
  return std::sqrt(squares / sum);
}

TEST(SynthTruth, FiltersAreWhatTheySay) {
  const double pi = std::acos(-1.0);
  const double gaussian = deviation_of([](double x) { return std::exp(-2 * x * x); });
  const double harris = deviation_of([pi](double x) {
    const double w = 2 * pi * (x / 3 + 0.5);
    return 0.35875 - 0.48829 * std::cos(w) + 0.14128 * std::cos(2 * w) - 0.01168 * std::cos(3 * w);
  });
  for (const auto& [filter, deviation, radius] : {std::tuple(Filter::box, std::sqrt(1 / 12.0), 0.5),
                                                  {Filter::gaussian, gaussian, 1.5},
                                                  {Filter::blackman_harris, harris, 1.5}}) {
    const FilterPositions position(filter);
    double mean = 0, squares = 0, last = -2;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
      const double x = position((i + 0.5) / n);
      EXPECT_GE(x, last);
      last = x;
      mean += x / n;
      squares += x * x / n;
    }
    EXPECT_NEAR(mean, 0, 1e-6);
    EXPECT_NEAR(std::sqrt(squares), deviation, 1e-3);
    EXPECT_GE(position(0), -radius - 1e-9);
    EXPECT_LE(position(1 - 0x1p-53), radius + 1e-9);
  }
}

TEST(SynthSamples, LieWhereTheJitterSays) {
  Workers workers(1);
  const Scene scene = make_scene("quality-all");
  const Moment moment = moment_of(scene, 7, 320, 180);
  const glm::dvec2 jitter{0.3125, -0.4};
  const Window window{40, 30, 80, 50};
  const Picture picture = render_samples(moment, window, {jitter, 0, 1}, workers);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      const Sample sample = evaluate(moment, x + 0.5 + jitter.x, y + 0.5 + jitter.y);
      ASSERT_EQ(picture.g.at(x, y), float(sample.color.g));
      ASSERT_EQ(picture.backward_x.at(x, y), float(sample.backward.x));
      ASSERT_EQ(picture.forward_y.at(x, y), float(sample.forward.y));
      ASSERT_EQ(picture.id.at(x, y), sample.id);
    }
}

TEST(SynthSamples, NoiseHasMeanOneAndItsDeviation) {
  Workers workers;
  const Scene scene = make_scene("still");
  const Moment moment = moment_of(scene, 1, 320, 180);
  const Window window{0, 0, 320, 180};
  const Picture clean = render_samples(moment, window, {{}, 0, 3}, workers),
                noisy = render_samples(moment, window, {{}, 0.5, 3}, workers);
  double mean = 0, squares = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      const double factor = noisy.r.at(x, y) / clean.r.at(x, y);
      EXPECT_GE(factor, 0);
      mean += factor;
      squares += factor * factor;
    }
  mean /= double(window.pixels());
  squares /= double(window.pixels());
  EXPECT_NEAR(mean, 1, 4 * 0.5 / 240);
  EXPECT_NEAR(std::sqrt(squares - mean * mean), 0.5, 0.02);
}

}  // namespace
}  // namespace varve::synth
