// Time per pixel of each pass, one thread, 1920x1080. Every loop checks that the answer is still the answer.
#include <benchmark/benchmark.h>

#include "motion/motion.h"
#include "resolve/accumulate.h"
#include "resolve/bspline.h"
#include "resolve/sample_weights.h"
#include "resolve/sharpen.h"
#include "support/scenes.h"

namespace varve {
namespace {

constexpr Window kFrame{0, 0, 1920, 1080};

struct Scene {
  Workers workers{1};
  Present present, next;
  History history;

  Scene() {
    present = test::noise_present(kFrame, {1, 0, 4, 0, true, 1}, workers);
    next = test::noise_present(kFrame, {2, 0, 4, 0, true, 1}, workers);
    // Vectors as scenes have them: smooth, with an edge here and there.
    for (int y = 0; y < kFrame.y1; ++y)
      for (int x = 0; x < kFrame.x1; ++x)
        next.motion.at(x, y) =
            glm::vec2(-3.3f + 0.001f * float(x), (x / 200 + y / 150) % 3 == 0 ? 5.7f : 0.3f + 0.002f * float(y));
    history = test::next_history(present, {}, {}, {}, workers);
  }
};

Scene& scene() {
  static Scene s;
  return s;
}

void per_pixel(benchmark::State& state) {
  state.counters["ns/px"] = benchmark::Counter(
      double(kFrame.pixels()) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void check(benchmark::State& state, bool good) {
  if (!good) state.SkipWithError("wrong answer");
}

void BM_copy_of_the_history(benchmark::State& state) {  // what memory alone costs
  scene();
  for (auto _ : state) {
    const Plane<glm::vec4> copy = scene().history.color.clone();
    check(state, copy.at(7, 7) == scene().history.color.at(7, 7));
  }
  per_pixel(state);
}

void BM_sanitize(benchmark::State& state) {
  for (auto _ : state) {
    sanitize(scene().next, scene().workers);
    check(state, scene().next.not_finite == 0);
  }
  per_pixel(state);
}

void BM_decode_motion(benchmark::State& state) {
  const Plane<float> x(kFrame, 0, 1.5f), y(kFrame, 0, -2.0f);
  for (auto _ : state) {
    std::size_t bad = 0;
    const Plane<glm::vec2> m = decode_motion(x, y, {}, kFrame, 1e4, scene().workers, bad);
    check(state, bad == 0 && m.at(9, 9) == glm::vec2(1.5f, -2.0f));
  }
  per_pixel(state);
}

void BM_dilate(benchmark::State& state, Dilation dilation) {
  for (auto _ : state) {
    state.PauseTiming();
    Plane<glm::vec2> motion = scene().next.motion.clone();
    state.ResumeTiming();
    const DilatedMotion d = dilate_motion(std::move(motion), scene().next.depth, dilation, scene().workers);
    check(state, d.motion.window() == kFrame);
  }
  per_pixel(state);
}

void BM_weigh_samples(benchmark::State& state, SampleFilter filter) {
  for (auto _ : state) {
    const WeighedPresent w = weigh_samples(scene().next, filter, {0.2, -0.3}, scene().workers);
    check(state, w.sample_weight.at(50, 50) > 0);
  }
  per_pixel(state);
}

void BM_unjitter(benchmark::State& state) {
  for (auto _ : state) {
    const Plane<glm::vec4> out = unjitter_bilinear(scene().next, {0.2, -0.3}, scene().workers);
    check(state, out.at(50, 50).a > 0);
  }
  per_pixel(state);
}

void BM_bspline_coefficients(benchmark::State& state, int degree) {
  for (auto _ : state) {
    const Plane<glm::vec4> out = bspline_coefficients(scene().history.color, degree, scene().workers);
    check(state, out.window() == kFrame);
  }
  per_pixel(state);
}

void BM_sharpen(benchmark::State& state) {
  for (auto _ : state) {
    const Plane<glm::vec4> out = sharpen(scene().history.color, scene().history.total, 0.5, scene().workers);
    check(state, out.at(7, 7).a == scene().history.color.at(7, 7).a);
  }
  per_pixel(state);
}

void BM_accumulate(benchmark::State& state, const RecursiveParameters& recursive, const RectifyParameters& rectify,
                   Isa isa) {
  for (auto _ : state) {
    const Accumulated a =
        accumulate(scene().next, scene().history, recursive, rectify, {}, 1, {}, scene().workers, isa);
    check(state, a.history.total.at(905, 500) == 2.0f);
  }
  per_pixel(state);
}

RecursiveParameters with_filter(HistoryFilter filter) {
  RecursiveParameters p;
  p.history_filter = filter;
  return p;
}

RectifyParameters with_box(Box box, BoxSpace space = BoxSpace::rgb, int window = 3) {
  RectifyParameters p;
  p.box = box;
  p.space = space;
  p.window = window;
  return p;
}

// The whole recursive step with channels that go with the color; without any it is BM_accumulate of the same choices.
void BM_companions(benchmark::State& state) {
  Scene& s = scene();
  s.next.companions.clear();
  s.history.companions.clear();
  for (int i = 0; i < int(state.range(0)); ++i) {
    s.next.companions.push_back(s.next.color.clone());
    s.history.companions.push_back(s.history.color.clone());
  }
  for (auto _ : state) {
    const Accumulated a = accumulate(s.next, s.history, {}, {}, {}, 1, {}, s.workers);
    for (const Plane<glm::vec4>& plane : a.history.companions)
      check(state, std::abs(plane.at(777, 555).g - a.history.color.at(777, 555).g) < 1e-5f);
  }
  s.next.companions.clear();
  s.history.companions.clear();
  per_pixel(state);
}

RectifyParameters with_shape(Box box, int window = 3, BoxRule rule = BoxRule::clip, int passes = 64) {
  RectifyParameters p = with_box(box, BoxSpace::rgb, window);
  p.rule = rule;
  p.hull_passes = passes;
  return p;
}

RectifyParameters with_moments(WindowMoments moments, int window, Box box = Box::variance) {
  RectifyParameters p = with_box(box, BoxSpace::rgb, window);
  p.moments = moments;
  return p;
}

BENCHMARK(BM_copy_of_the_history)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_sanitize)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_decode_motion)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_dilate, nearest, Dilation::nearest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_dilate, longest, Dilation::longest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_weigh_samples, tent, SampleFilter::tent)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_weigh_samples, gaussian, SampleFilter::gaussian)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_weigh_samples, blackman_harris, SampleFilter::blackman_harris)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_unjitter)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_bspline_coefficients, 3, 3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_bspline_coefficients, 5, 5)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_sharpen)->Unit(benchmark::kMillisecond);
// The whole row kernel, choice by choice; `salvi` is the preset.
#define ACCUMULATE(name, recursive, rectify, isa) \
  BENCHMARK_CAPTURE(BM_accumulate, name, recursive, rectify, isa)->Unit(benchmark::kMillisecond)
ACCUMULATE(salvi, {}, {}, Isa::automatic);
ACCUMULATE(salvi_baseline, {}, {}, Isa::baseline);
ACCUMULATE(bilinear_no_box, with_filter(HistoryFilter::bilinear), with_box(Box::none), Isa::automatic);
ACCUMULATE(catmull_rom_no_box, {}, with_box(Box::none), Isa::automatic);
ACCUMULATE(catmull_rom9_no_box, with_filter(HistoryFilter::catmull_rom9), with_box(Box::none), Isa::automatic);
ACCUMULATE(catmull_rom5_no_box, with_filter(HistoryFilter::catmull_rom5), with_box(Box::none), Isa::automatic);
ACCUMULATE(cubic_no_box, with_filter(HistoryFilter::cubic), with_box(Box::none), Isa::automatic);
ACCUMULATE(bspline3_no_box, with_filter(HistoryFilter::bspline3), with_box(Box::none), Isa::automatic);
ACCUMULATE(bspline5_no_box, with_filter(HistoryFilter::bspline5), with_box(Box::none), Isa::automatic);
ACCUMULATE(minmax, {}, with_box(Box::minmax), Isa::automatic);
ACCUMULATE(variance_minmax, {}, with_box(Box::variance_minmax), Isa::automatic);
ACCUMULATE(variance_ycocg, {}, with_box(Box::variance, BoxSpace::ycocg), Isa::automatic);
ACCUMULATE(variance_5x5, {}, with_box(Box::variance, BoxSpace::rgb, 5), Isa::automatic);
ACCUMULATE(variance_7x7, {}, with_box(Box::variance, BoxSpace::rgb, 7), Isa::automatic);
BENCHMARK(BM_companions)->Arg(0)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond);
// Shapes beyond the row kernel.
ACCUMULATE(rounded, {}, with_shape(Box::rounded), Isa::automatic);
ACCUMULATE(dynamic4, {}, with_shape(Box::dynamic4), Isa::automatic);
ACCUMULATE(kdop7, {}, with_shape(Box::kdop7), Isa::automatic);
ACCUMULATE(kdop13, {}, with_shape(Box::kdop13), Isa::automatic);
ACCUMULATE(kdop13_project, {}, with_shape(Box::kdop13, 3, BoxRule::project), Isa::automatic);
ACCUMULATE(pca, {}, with_shape(Box::pca), Isa::automatic);
ACCUMULATE(ellipsoid, {}, with_shape(Box::ellipsoid), Isa::automatic);
ACCUMULATE(hull, {}, with_shape(Box::hull), Isa::automatic);
ACCUMULATE(hull_4_passes, {}, with_shape(Box::hull, 3, BoxRule::clip, 4), Isa::automatic);
ACCUMULATE(hull_project, {}, with_shape(Box::hull, 3, BoxRule::project), Isa::automatic);
ACCUMULATE(hull_7x7, {}, with_shape(Box::hull, 7), Isa::automatic);
ACCUMULATE(variance_project, {}, with_shape(Box::variance, 3, BoxRule::project), Isa::automatic);
ACCUMULATE(variance_log, {}, with_box(Box::variance, BoxSpace::log), Isa::automatic);
// The promise: 63 costs at most 1.3 times 7, by the same method.
ACCUMULATE(separable_7, {}, with_moments(WindowMoments::separable, 7), Isa::automatic);
ACCUMULATE(separable_31, {}, with_moments(WindowMoments::separable, 31), Isa::automatic);
ACCUMULATE(separable_63, {}, with_moments(WindowMoments::separable, 63), Isa::automatic);
ACCUMULATE(separable_7_cut, {}, with_moments(WindowMoments::separable, 7, Box::variance_minmax), Isa::automatic);
ACCUMULATE(separable_63_cut, {}, with_moments(WindowMoments::separable, 63, Box::variance_minmax), Isa::automatic);
ACCUMULATE(minmax_7, {}, with_moments(WindowMoments::separable, 7, Box::minmax), Isa::automatic);
ACCUMULATE(minmax_63, {}, with_moments(WindowMoments::separable, 63, Box::minmax), Isa::automatic);
ACCUMULATE(gaussian_7, {}, with_moments(WindowMoments::gaussian, 7), Isa::automatic);
ACCUMULATE(gaussian_63, {}, with_moments(WindowMoments::gaussian, 63), Isa::automatic);
ACCUMULATE(pyramid_7, {}, with_moments(WindowMoments::pyramid, 7), Isa::automatic);
ACCUMULATE(pyramid_63, {}, with_moments(WindowMoments::pyramid, 63), Isa::automatic);

}  // namespace
}  // namespace varve

BENCHMARK_MAIN();
