// Several samples in each pixel become one: against the slow twin, and the laws.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "reference/samples_reference.h"
#include "samples/mean_of_results.h"
#include "samples/resolve_samples.h"
#include "support/gather_scenes.h"

namespace varve {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr SampleFilter kFilters[] = {SampleFilter::none, SampleFilter::tent, SampleFilter::gaussian,
                                     SampleFilter::blackman_harris, SampleFilter::mitchell};

/// Numbers that look like chance, in [0, 1).
double chance(int n) { return test::halton(n * 7919 % 100003 + 1, 5); }

struct SetOptions {
  int samples = 3;
  Window window{-3, 2, 14, 15};
  bool holes = true;  ///< some pixels and vectors are not finite
};

std::vector<Present> make_samples(const SetOptions& o, Workers& workers,
                                  const std::function<glm::vec4(int)>& color_of = {}) {
  std::vector<Present> samples;
  int n = 0;
  for (int s = 0; s < o.samples; ++s) {
    Present p;
    const Window& w = o.window;
    p.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0));
    p.companions.emplace_back(w, kPresentBorder, glm::vec4(0));
    p.motion = Plane<glm::vec2>(w), p.depth = Plane<float>(w), p.id = Plane<std::uint32_t>(w);
    p.reactive = Plane<float>(w);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        ++n;
        p.color.at(x, y) = color_of
                               ? color_of(n)
                               : glm::vec4(float(chance(n)), float(2 * chance(n + 1)), float(chance(n + 2) - 0.2), 1);
        if (o.holes && chance(n + 3) < 0.2) p.color.at(x, y).g = kNan;
        p.companions[0].at(x, y) = p.color.at(x, y) * 0.5f;
        // Few different lengths and depths, so that there are ties.
        p.motion.at(x, y) = glm::vec2(std::floor(3 * chance(n + 4)) - 1, 0);
        if (o.holes && chance(n + 5) < 0.2) p.motion.at(x, y).y = kNan;
        p.depth.at(x, y) = float(1 + std::floor(2 * chance(n + 6)));
        p.id.at(x, y) = std::uint32_t(n);
        p.reactive.at(x, y) = float(chance(n + 7));
      }
    p.jitter = glm::dvec2(test::halton(s + 1, 2) - 0.5, test::halton(s + 1, 3) - 0.5);
    sanitize(p, workers);
    sanitize_companions(p, workers);
    samples.push_back(std::move(p));
  }
  return samples;
}

std::vector<const Present*> pointers(const std::vector<Present>& samples) {
  std::vector<const Present*> all;
  for (const Present& p : samples) all.push_back(&p);
  return all;
}

template <class Use>
void for_pixels(const Window& w, const Use& use) {
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) use(x, y);
}

bool same_bits(const glm::vec4& a, const glm::vec4& b) {
  for (int k = 0; k < 4; ++k)
    if (std::bit_cast<std::uint32_t>(a[k]) != std::bit_cast<std::uint32_t>(b[k])) return false;
  return true;
}

TEST(ResolveSamples, IsItsSlowTwin) {
  Workers workers(2);
  for (const SampleFilter filter : kFilters)
    for (const int count : {1, 2, 3, 5}) {
      const std::vector<Present> samples = make_samples({.samples = count}, workers);
      const Present fast = resolve_samples(pointers(samples), filter, workers);
      for_pixels(fast.color.window(), [&](int x, int y) {
        const reference::ResolvedPixel slow = reference::resolved_pixel(samples, filter, x, y);
        for (int k = 0; k < 4; ++k) {
          ASSERT_NEAR(double(fast.color.at(x, y)[k]), slow.color[k], 1e-6) << x << "," << y;
          ASSERT_NEAR(double(fast.companions[0].at(x, y)[k]), slow.color[k] * 0.5, 1e-6);
        }
        const float weight = fast.sample_weight.empty() ? 1.0f : fast.sample_weight.at(x, y);
        ASSERT_NEAR(double(weight), slow.weight, 1e-6);
        ASSERT_EQ(fast.id.at(x, y), samples[slow.chosen].id.at(x, y));
        ASSERT_EQ(fast.depth.at(x, y), samples[slow.chosen].depth.at(x, y));
        ASSERT_EQ(std::bit_cast<std::uint32_t>(fast.motion.at(x, y).y),
                  std::bit_cast<std::uint32_t>(samples[slow.chosen].motion.at(x, y).y));
        bool valid = false;
        for (const Present& p : samples) valid = valid || p.valid.at(x, y) > 0;
        ASSERT_EQ(fast.valid.at(x, y), valid ? 1.0f : 0.0f);
      });
    }
}

TEST(ResolveSamples, OneSampleKeepsItsBits) {
  Workers workers(2);
  const std::vector<Present> samples = make_samples({.samples = 1}, workers);
  const Present one = resolve_samples(pointers(samples), SampleFilter::none, workers);
  for_pixels(one.color.window(), [&](int x, int y) {
    ASSERT_TRUE(same_bits(one.color.at(x, y), samples[0].color.at(x, y)));
    ASSERT_EQ(one.valid.at(x, y), samples[0].valid.at(x, y));
  });
  EXPECT_EQ(one.jitter, samples[0].jitter);
  EXPECT_EQ(one.not_finite, samples[0].not_finite);
  EXPECT_EQ(one.rows_valid, samples[0].rows_valid);
}

TEST(ResolveSamples, EqualSamplesGiveThatColorWhateverItIs) {
  Workers workers(2);
  for (const float value : {0.0f, 0.1f, -3.7f, 65504.0f, 1e30f, 3e38f, 1e-42f})
    for (const SampleFilter filter : kFilters) {
      const auto constant = [value](int) { return glm::vec4(value); };
      const std::vector<Present> samples = make_samples({.samples = 3, .holes = false}, workers, constant);
      const Present out = resolve_samples(pointers(samples), filter, workers);
      for_pixels(out.color.window(), [&](int x, int y) {
        ASSERT_TRUE(same_bits(out.color.at(x, y), glm::vec4(value))) << value << " " << int(filter);
      });
    }
}

TEST(ResolveSamples, ScalesByPowersOfTwoBitForBitOnAnyNumberOfThreads) {
  Workers one(1), three(3);
  for (const SampleFilter filter : kFilters) {
    const std::vector<Present> samples = make_samples({.samples = 4}, one);
    std::vector<Present> scaled = make_samples({.samples = 4}, one);
    for (Present& p : scaled) for_pixels(p.color.window(), [&](int x, int y) { p.color.at(x, y) *= 1024.0f; });
    const Present a = resolve_samples(pointers(samples), filter, one),
                  b = resolve_samples(pointers(scaled), filter, three);
    for_pixels(a.color.window(), [&](int x, int y) {
      ASSERT_TRUE(same_bits(a.color.at(x, y) * 1024.0f, b.color.at(x, y)));
      ASSERT_EQ(a.id.at(x, y), b.id.at(x, y));
    });
  }
}

TEST(ResolveSamples, TakesTheLongestVectorThenTheNearestThenTheFirst) {
  Workers workers(1);
  std::vector<Present> samples = make_samples({.samples = 3, .window = {0, 0, 4, 1}, .holes = false}, workers);
  const auto set = [&](int s, int x, glm::vec2 v, float depth) {
    samples[std::size_t(s)].motion.at(x, 0) = v, samples[std::size_t(s)].depth.at(x, 0) = depth;
  };
  const float far = std::numeric_limits<float>::infinity();
  set(0, 0, {1, 0}, 1), set(1, 0, {0, -5}, far), set(2, 0, {4, 2}, 2);  // longest, though far
  set(0, 1, {3, 4}, 7), set(1, 1, {5, 0}, 3), set(2, 1, {0, 5}, 3);     // equal lengths: nearest, then first
  set(0, 2, {kNan, 9}, 1), set(1, 2, {0, 0}, 5), set(2, 2, {0, 0}, 4);  // no vector has no say
  set(0, 3, {9, 9}, 1), set(1, 3, {1, 0}, 5), set(2, 3, {2, 0}, 4);     // nor has a sample without a color
  samples[0].valid.at(3, 0) = 0;
  const Present out = resolve_samples(pointers(samples), SampleFilter::none, workers);
  EXPECT_EQ(out.motion.at(0, 0), glm::vec2(0, -5));
  EXPECT_EQ(out.depth.at(0, 0), far);
  EXPECT_EQ(out.id.at(1, 0), samples[1].id.at(1, 0));
  EXPECT_EQ(out.depth.at(2, 0), 4.0f);
  EXPECT_EQ(out.motion.at(3, 0), glm::vec2(2, 0));
}

TEST(ResolveSamples, StandsForTheMeanPositionUnlessAllPositionsWereUsed) {
  Workers workers(1);
  std::vector<Present> samples = make_samples({.samples = 2}, workers);
  samples[0].jitter = glm::dvec2(0.25, -0.5), samples[1].jitter = glm::dvec2(-0.5, 0.25);
  EXPECT_EQ(resolve_samples(pointers(samples), SampleFilter::none, workers).jitter, glm::dvec2(-0.125, -0.125));
  EXPECT_FALSE(resolve_samples(pointers(samples), SampleFilter::tent, workers).jitter);
  samples[1].jitter.reset();
  EXPECT_FALSE(resolve_samples(pointers(samples), SampleFilter::none, workers).jitter);
  EXPECT_TRUE(resolve_samples(pointers(samples), SampleFilter::tent, workers).sample_weight.empty());
}

TEST(MeanOfResults, AveragesWhatHasBeenSeenAndAddsUpCounts) {
  Workers workers(2);
  const Window w{0, 0, 3, 1};
  std::vector<Accumulated> results(2);
  for (std::size_t s = 0; s < 2; ++s) {
    History& h = results[s].history;
    h.color = Plane<glm::vec4>(w, 0, glm::vec4(s == 0 ? 1.0f : 4.0f));
    h.total = Plane<float>(w, 0, 5.0f), h.spread = Plane<float>(w, 0, 0.2f);
    results[s].diagnostics.reject = Plane<std::uint32_t>(w, 0, std::uint32_t(1) << s);
    results[s].diagnostics.clip = Plane<float>(w, 0, float(s));
  }
  results[1].history.total.at(1, 0) = 0;
  const Accumulated mean = mean_of_results(std::vector<const Accumulated*>{&results[0], &results[1]}, workers);
  EXPECT_EQ(mean.history.color.at(0, 0), glm::vec4(2.5f));
  EXPECT_EQ(mean.history.color.at(1, 0), glm::vec4(1.0f));
  EXPECT_EQ(mean.history.total.at(0, 0), 10.0f);
  EXPECT_FLOAT_EQ(1 / mean.history.spread.at(0, 0), 10.0f);
  EXPECT_FLOAT_EQ(1 / mean.history.spread.at(1, 0), 5.0f);
  EXPECT_EQ(mean.diagnostics.reject.at(2, 0), 3u);
  EXPECT_EQ(mean.diagnostics.clip.at(2, 0), 0.5f);
  EXPECT_TRUE(mean.diagnostics.weight.empty());
}

}  // namespace
}  // namespace varve
