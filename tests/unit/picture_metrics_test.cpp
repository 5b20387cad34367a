// Metrics of single pictures against closed forms and slow twins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "diagnose/channel_difference.h"
#include "diagnose/color_error.h"
#include "diagnose/edge_mtf.h"
#include "diagnose/metric.h"
#include "diagnose/ssim.h"

namespace varve {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN(), kInfF = std::numeric_limits<float>::infinity();

Plane<glm::vec4> noise(const Window& window, unsigned seed, float scale = 1) {
  std::mt19937 random(seed);
  Plane<glm::vec4> out(window);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x)
      out.at(x, y) =
          scale * glm::vec4(float(random() % 1000), float(random() % 1000), float(random() % 1000), 1000) / 1000.f;
  return out;
}

class PictureMetrics : public testing::Test {
 protected:
  ColorPair pair(Plane<glm::vec4> a, Plane<glm::vec4> b, bool nan_equal = false) {
    return make_color_pair(std::move(a), std::move(b), nan_equal, workers);
  }
  ColorError error(const ColorPair& p) { return color_error(p, 100, table, workers); }
  Workers workers{2};
  PuTable table;
  Window window{-3, 5, 40, 30};
};

TEST(ChannelDifference, CountsWhatIsNotFiniteFirst) {
  const std::vector<double> a = {0.5, kNan, kInf, kInf, kNan, 1, 0.0}, b = {kNan, 0.5, -kInf, kInf, kNan, 1, -0.0};
  ChannelDifference d = difference_of(a, b, false);
  EXPECT_EQ(d.not_finite, 4u);
  EXPECT_EQ(d.differing, 5u);  // and the sign of the zero
  EXPECT_EQ(d.bad_a, 4u);
  EXPECT_EQ(d.bad_b, 4u);
  EXPECT_EQ(d.greatest, kInf);
  EXPECT_EQ(d.finite, 2u);
  EXPECT_EQ(difference_of(a, b, true).not_finite, 3u);
}

TEST(ChannelDifference, KnowsAKnownOffset) {
  const std::vector<double> a = {1, 2, 3, 4}, b = {1.5, 1.5, 3.5, 3.5};
  ChannelDifference d = difference_of(a, b, false);
  d += difference_of(a, a, false);
  EXPECT_DOUBLE_EQ(d.mean(), 0.25);
  EXPECT_DOUBLE_EQ(d.rmse(), std::sqrt(0.125));
  EXPECT_EQ(d.greatest, 0.5);
  EXPECT_EQ(d.differing, 4u);
}

TEST_F(PictureMetrics, KnownOffset) {
  const ColorError e =
      error(pair(Plane<glm::vec4>(window, 0, glm::vec4(0.5f)), Plane<glm::vec4>(window, 0, glm::vec4(0.625f))));
  EXPECT_NEAR(e.psnr(), 20 * std::log10(8.0), 1e-9);
  EXPECT_NEAR(e.psnr_tone(), -20 * std::log10(0.625 / 1.625 - 0.5 / 1.5), 1e-9);
  EXPECT_NEAR(e.psnr_pu(), 20 * std::log10(pu_encode(100) / (pu_encode(62.5) - pu_encode(50))), 1e-3);
  EXPECT_DOUBLE_EQ(e.rmse(), 0.125);
  EXPECT_DOUBLE_EQ(e.mean(), 0.125);
  EXPECT_NEAR(e.relmse(), 0.015625 / (0.25 + 0.01 * 0.25), 1e-7);
}

TEST_F(PictureMetrics, EqualPicturesAreInfinitelyGood) {
  const ColorPair p = pair(noise(window, 1), noise(window, 1));
  const ColorError e = error(p);
  EXPECT_EQ(e.psnr(), kInf);
  EXPECT_EQ(e.greatest, 0);
  EXPECT_DOUBLE_EQ(ssim(p, workers), 1);
}

TEST_F(PictureMetrics, NegativeValuesAndValuesAboveOneAreHeldToTheRange) {
  const ColorError e =
      error(pair(Plane<glm::vec4>(window, 0, glm::vec4(-1)), Plane<glm::vec4>(window, 0, glm::vec4(0))));
  EXPECT_EQ(e.psnr(), kInf);
  EXPECT_EQ(e.psnr_tone(), kInf);
  EXPECT_DOUBLE_EQ(e.rmse(), 1);
  EXPECT_EQ(error(pair(Plane<glm::vec4>(window, 0, glm::vec4(1)), Plane<glm::vec4>(window, 0, glm::vec4(9)))).psnr(),
            kInf);
}

TEST_F(PictureMetrics, BadPixelsCanOnlyMakeItWorse) {
  const auto with = [&](float value) {
    auto b = noise(window, 1);
    b.at(0, 10).g = value;
    return b;
  };
  for (float value : {kNanF, kInfF, -kInfF}) {
    const ColorPair p = pair(noise(window, 1), with(value));
    EXPECT_EQ(p.bad_pixels, 1u);
    const ColorError e = error(p);
    EXPECT_EQ(e.bad, 3u);
    EXPECT_EQ(e.greatest, kInf);
    EXPECT_NEAR(e.psnr(), 10 * std::log10(double(window.pixels())), 1e-9);
    EXPECT_LT(ssim(p, workers), 1);
  }
  EXPECT_EQ(pair(with(kInfF), with(kInfF)).bad_pixels, 0u);
  EXPECT_EQ(pair(with(kInfF), with(-kInfF)).bad_pixels, 1u);
  EXPECT_EQ(pair(with(kNanF), with(kNanF)).bad_pixels, 1u);
  EXPECT_EQ(pair(with(kNanF), with(kNanF), true).bad_pixels, 0u);
}

TEST_F(PictureMetrics, HugeFiniteValuesStayNumbers) {
  const float huge = std::numeric_limits<float>::max();
  const ColorPair p = pair(Plane<glm::vec4>(window, 0, glm::vec4(huge)), Plane<glm::vec4>(window, 0, glm::vec4(-huge)));
  const ColorError e = error(p);
  EXPECT_TRUE(std::isfinite(e.rmse()) && std::isfinite(e.relmse()) && std::isfinite(e.psnr()));
  EXPECT_TRUE(std::isfinite(ssim(p, workers)));
}

TEST_F(PictureMetrics, PuHitsItsPublishedValuesAndTheTableFollows) {
  EXPECT_NEAR(pu_encode(100), 256.4, 0.05);
  EXPECT_NEAR(pu_encode(10000), 595.4, 0.05);
  EXPECT_NEAR(pu_encode(0.005), 0, 0.1);
  for (double y = 0.001; y < 20000; y *= 1.0137) EXPECT_NEAR(double(table.encode(float(y))), pu_encode(y), 1e-3) << y;
  EXPECT_EQ(table.encode(kNanF), table.encode(0));
}

/// The definition, with variances as squared distances from the mean.
double slow_ssim(const ColorPair& p) {
  const Window& w = p.window();
  const auto value = [&](const Plane<glm::vec4>& c, int x, int y) {
    const double l = double(luminance(c.at(std::clamp(x, w.x0, w.x1 - 1), std::clamp(y, w.y0, w.y1 - 1))));
    return l / (1 + l);
  };
  double total = 0;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      double n = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
      for (int pass = 0; pass < 2; ++pass)
        for (int j = -5; j <= 5; ++j)
          for (int i = -5; i <= 5; ++i) {
            const double g = std::exp(-(i * i + j * j) / 4.5), a = value(p.a, x + i, y + j),
                         b = value(p.b, x + i, y + j);
            if (pass == 0) {
              n += g, ma += g * a, mb += g * b;
              continue;
            }
            va += g * (a - ma / n) * (a - ma / n), vb += g * (b - mb / n) * (b - mb / n);
            cov += g * (a - ma / n) * (b - mb / n);
          }
      ma /= n, mb /= n, va /= n, vb /= n, cov /= n;
      total += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
    }
  return total / double(w.pixels());
}

TEST_F(PictureMetrics, SsimEqualsItsDefinition) {
  const ColorPair p = pair(noise(window, 1), noise(window, 2));
  EXPECT_NEAR(ssim(p, workers), slow_ssim(p), 1e-6);
  EXPECT_LT(ssim(p, workers), 0.5);
}

TEST_F(PictureMetrics, ThreadsDoNotChangeABit) {
  Workers one(1);
  const ColorPair p = pair(noise(window, 1, 5), noise(window, 2, 5));
  EXPECT_EQ(error(p).pu, color_error(p, 100, table, one).pu);
  EXPECT_EQ(ssim(p, workers), ssim(p, one));
}

/// An edge 5 degrees off the vertical, `profile` of the signed distance in pixels.
template <class Profile>
Plane<float> slanted(const Profile& profile, bool turned) {
  Plane<float> out(Window{10, 20, 74, 84});
  const double c = std::cos(5 * std::numbers::pi / 180), s = std::sin(5 * std::numbers::pi / 180);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      (turned ? out.at(10 + y, 20 + x) : out.at(10 + x, 20 + y)) =
          float(2 + 3 * profile((x - 31.3) * c + (y - 30.1) * s));
  return out;
}

TEST(EdgeMtf, GaussianEdge) {
  for (double sigma : {0.6, 1.0, 2.0})
    for (bool turned : {false, true}) {
      const auto e = edge_sharpness(
          slanted([&](double d) { return 0.5 * (1 + std::erf(d / (sigma * std::numbers::sqrt2))); }, turned));
      ASSERT_TRUE(e);
      EXPECT_NEAR(e->mtf50, std::sqrt(std::log(2.0) / 2) / (std::numbers::pi * sigma), 0.01 / sigma);
      EXPECT_NEAR(e->width, 2.5631 * sigma, 0.06);
      EXPECT_NEAR(e->variance, sigma * sigma, 0.03 + 0.02 * sigma * sigma);
      EXPECT_NEAR(e->mtf[16], std::exp(-2 * std::pow(std::numbers::pi * sigma * 0.25, 2)), 0.02);
    }
}

TEST(EdgeMtf, BoxEdge) {
  const auto e = edge_sharpness(slanted([](double d) { return std::clamp(d + 0.5, 0.0, 1.0); }, false));
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->mtf50, 0.6034, 0.02);
  EXPECT_NEAR(e->variance, 1.0 / 12, 0.03);
  EXPECT_NEAR(e->mtf[32], 2 / std::numbers::pi, 0.02);
}

TEST(EdgeMtf, NoEdgeIsToldNotInvented) {
  EXPECT_FALSE(edge_sharpness(Plane<float>(Window{0, 0, 64, 64}, 0, 0.5f)));
  EXPECT_FALSE(edge_sharpness(Plane<float>(Window{0, 0, 64, 64}, 0, kNanF)));
  EXPECT_FALSE(edge_sharpness(slanted([](double d) { return d > 0 ? kInf : 0.0; }, false)));
  EXPECT_FALSE(edge_sharpness(Plane<float>(Window{0, 0, 4, 64}, 0, 1.f)));
}

TEST(Metric, LimitsFailOnNan) {
  EXPECT_TRUE(holds({MetricId::psnr, 30, true}, kInf));
  EXPECT_TRUE(holds({MetricId::psnr, 30, true}, 30));
  EXPECT_FALSE(holds({MetricId::psnr, 30, true}, 29.9));
  EXPECT_TRUE(holds({MetricId::max, 0.1, true}, 0.1));
  EXPECT_FALSE(holds({MetricId::max, 0.1, true}, kInf));
  for (const Metric& metric : metrics()) EXPECT_FALSE(holds({metric.id, 1, true}, kNan)) << metric.name;
  for (const Metric& metric : metrics()) EXPECT_EQ(&metric_of(metric.id), find_metric(metric.name));
}

}  // namespace
}  // namespace varve
