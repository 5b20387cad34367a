// The gather and its slow twin.
#include <gtest/gtest.h>

#include "gather/carry.h"
#include "reference/gather_reference.h"
#include "support/gather_scenes.h"

namespace varve {
namespace {

using test::ShotOptions;
using test::TwoPlanes;

/// Greatest difference from the twin, relative to the brightest color of the shot (1.5).
double worst_difference(const ShotOptions& options, std::size_t present, const GatherParameters& parameters,
                        Workers& workers) {
  const test::Shot shot = take(TwoPlanes{}, options, workers);
  const std::vector<GatherSource> sources = shot.sources();
  const auto carried = reference::carry_samples(sources, present, shot.test());
  const Accumulated fast = gather(sources, present, parameters, shot.test(), {}, workers);
  const Window& w = sources[present * shot.samples].window();
  std::vector<double> worst(std::size_t(w.height()), 0.0);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::dvec4 slow = reference::gathered_pixel(sources, present, carried, parameters, shot.test(), x, y);
      for (int k = 0; k < 4; ++k) {
        double& most = worst[std::size_t(y - w.y0)];
        const double d = std::fabs(double(fast.history.color.at(x, y)[k]) - slow[k]) / 1.5;
        most = d <= most ? most : d;  // NaN counts
      }
    }
  });
  double most = 0;
  for (const double d : worst) most = d <= most ? most : d;
  return most;
}

GatherParameters plain(int cells, SampleFilter filter) {
  GatherParameters p;
  p.gain = false, p.change_limit = 0;
  p.cells = cells, p.filter = filter;
  return p;
}

TEST(GatherTwin, SameForAnyCellsAndFilter) {
  Workers workers(2);
  for (int cells = 1; cells <= 6; ++cells)
    EXPECT_LT(worst_difference({.frames = 5}, 2, plain(cells, SampleFilter::none), workers), 2e-6) << cells;
  for (const SampleFilter filter : {SampleFilter::tent, SampleFilter::gaussian, SampleFilter::blackman_harris})
    EXPECT_LT(worst_difference({.frames = 5, .window = {0, 0, 21, 19}}, 2, plain(3, filter), workers), 2e-6);
}

TEST(GatherTwin, SameWhateverTheFilesHave) {
  Workers workers(2);
  for (const bool ids : {true, false})
    for (const bool depths : {true, false})
      for (const glm::ivec2 motion : {glm::ivec2(0), glm::ivec2(1, -1)})
        for (const bool jitter : {true, false})
          EXPECT_LT(
              worst_difference({.frames = 6, .window_motion = motion, .ids = ids, .depths = depths, .jitter = jitter},
                               1, plain(4, SampleFilter::none), workers),
              2e-6)
              << ids << depths << motion.x << jitter;
}

TEST(GatherTwin, SameWithSeveralSamplesInEachPixel) {
  Workers workers(2);
  for (const int samples : {2, 3})
    for (const bool ids : {true, false})
      EXPECT_LT(worst_difference(
                    {.frames = 5, .window = {0, 0, 21, 19}, .window_motion = {1, 0}, .ids = ids, .samples = samples}, 2,
                    plain(3, SampleFilter::none), workers),
                2e-6)
          << samples << ids;
}

TEST(GatherTwin, CarriesTheSame) {
  Workers workers(2);
  const test::Shot shot = take(TwoPlanes{}, {.frames = 7, .window_motion = {1, 0}}, workers);
  const std::vector<GatherSource> sources = shot.sources();
  const auto slow = reference::carry_samples(sources, 6, shot.test());
  std::vector<Carried> fast(7);
  fast[6] = carry_present(sources[6], workers);
  for (std::size_t f = 6; f-- > 0;) {
    fast[f] = carry(sources[f], true, shot.test(), {&sources[f + 1], &fast[f + 1]},
                    f < 5 ? Followed{&sources[f + 2], &fast[f + 2]} : Followed{}, workers);
    const Window& w = sources[f].window();
    std::size_t i = 0, followed = 0;
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x, ++i) {
        const glm::vec3 a = fast[f].at(x, y);
        const glm::dvec3 b = slow[f][i];
        ASSERT_EQ(a.x == a.x, b.x == b.x) << f << ": " << x << "," << y;
        if (!(a.x == a.x)) continue;
        ++followed;
        for (int k = 0; k < 3; ++k) ASSERT_NEAR(double(a[k]), b[k], 1e-5);
      }
    EXPECT_GT(followed, i / 2);
  }
}

}  // namespace
}  // namespace varve
