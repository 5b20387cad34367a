// Deep pixels against the slow way, and the laws that hold for both.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "deep/flatten.h"
#include "reference/deep_reference.h"

namespace varve::test {
namespace {

using reference::Piece;

DeepSample sample_of(const Piece& piece, std::size_t index = 0) {
  DeepSample sample;
  sample.front = piece.front;
  sample.back = piece.back;
  sample.opacity = glm::dvec4(piece.alpha);
  sample.color = glm::dvec4(piece.color, 0, 0, 0);
  sample.index = std::uint32_t(index);
  return sample;
}

FlatPixel flatten_pieces(const std::vector<Piece>& pieces, FlattenScratch& scratch,
                         LayerRule rule = LayerRule::variation) {
  std::vector<DeepSample> samples;
  for (std::size_t i = 0; i < pieces.size(); ++i) samples.push_back(sample_of(pieces[i], i));
  return flatten(samples, false, rule, scratch);
}

FlatPixel flatten_pieces(const std::vector<Piece>& pieces) {
  FlattenScratch scratch;
  return flatten_pieces(pieces, scratch);
}

/// Points and volumes that meet, coincide, hide and emit.
std::vector<Piece> random_pixel(std::mt19937& random, std::size_t count, bool volumes) {
  const auto pick = [&](int n) { return int(random() % unsigned(n)); };
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < count; ++i) {
    Piece piece;
    piece.front = 1 + pick(12);
    piece.back = piece.front + (volumes && pick(3) > 0 ? 1 + pick(6) : 0);
    const int kind = pick(8);
    piece.alpha = kind == 0 ? 0 : kind == 1 ? 1 : std::ldexp(double(random() % 1000), -10);
    piece.color = std::ldexp(double(random() % 4096), -8);
    pieces.push_back(piece);
  }
  return pieces;
}

TEST(DeepTidy, SplitRecombinesExactly) {
  for (const double alpha : {0.0, 1e-12, 0.02, 0.5, 0.999999, 1.0})
    for (const double z : {1.0001, 2.0, 4.75}) {
      const Piece whole{1, 5, alpha, 0.7, {1}};
      const std::vector<Piece> parts = reference::split(whole, z);
      const double t = 1 - parts[0].alpha;
      EXPECT_NEAR(parts[0].color + t * parts[1].color, 0.7, 1e-12) << alpha << " at " << z;
      EXPECT_NEAR(parts[0].alpha + t * parts[1].alpha, alpha, 1e-12);
      const FlatPixel flat = flatten_pieces(parts);
      EXPECT_NEAR(flat.color.r, 0.7, 1e-12);
      EXPECT_NEAR(flat.color.a, alpha, 1e-12);
    }
}

TEST(DeepTidy, MergeIsTheLimitOfInterleavedSlices) {
  const Piece a{0, 1, 0.8, 0.6, {}}, b{0, 1, 0.3, 0.9, {}};
  constexpr int kSlices = 400000;
  double color = 0, t = 1;
  for (int i = 0; i < kSlices; ++i)
    for (const Piece& piece : {a, b}) {
      const double alpha = -std::expm1(std::log1p(-piece.alpha) / kSlices);
      color += t * piece.color * alpha / piece.alpha;
      t *= 1 - alpha;
    }
  const FlatPixel flat = flatten_pieces({a, b});
  EXPECT_NEAR(flat.color.r, color, 1e-6);
  EXPECT_NEAR(1 - flat.color.a, t, 1e-10);
}

TEST(DeepTidy, OverlappingVolumesAreSplit) {
  // Composited as they stand, front by front, the color would be .8.
  const FlatPixel flat = flatten_pieces({{1, 3, 0.8, 0.8, {}}, {2, 4, 0.8, 0, {}}});
  EXPECT_NEAR(flat.color.r, 0.7317, 5e-5);
  EXPECT_NEAR(flat.color.a, 0.96, 1e-12);
}

TEST(DeepTidy, TidyTwiceIsTidyOnce) {
  std::mt19937 random(5);
  for (int k = 0; k < 50; ++k) {
    const std::vector<Piece> once = reference::tidy(random_pixel(random, 6, true)), twice = reference::tidy(once);
    ASSERT_EQ(once.size(), twice.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
      EXPECT_EQ(once[i].alpha, twice[i].alpha);
      EXPECT_EQ(once[i].color, twice[i].color);
      EXPECT_EQ(once[i].front, twice[i].front);
      EXPECT_EQ(once[i].back, twice[i].back);
    }
    const FlatPixel tidied = flatten_pieces(once);
    const reference::Flat flat = reference::flatten(once);
    EXPECT_NEAR(tidied.color.r, flat.color, 1e-12 * (1 + flat.color));
  }
}

TEST(DeepFlatten, EqualsSplitSortMergeOver) {
  std::mt19937 random(1);
  FlattenScratch scratch;
  for (int k = 0; k < 3000; ++k) {
    const std::vector<Piece> pieces = random_pixel(random, 1 + random() % 13, k % 4 > 0);
    const reference::Flat flat = reference::flatten(reference::tidy(pieces));
    const FlatPixel ours = flatten_pieces(pieces, scratch);
    ASSERT_NEAR(ours.color.r, flat.color, 1e-11 * (1 + flat.color)) << "pixel " << k;
    ASSERT_NEAR(ours.color.a, flat.alpha, 1e-12) << "pixel " << k;
    const double largest = *std::max_element(flat.variation.begin(), flat.variation.end());
    ASSERT_NEAR(flat.variation[ours.winner], largest, 1e-12) << "pixel " << k;
    ASSERT_NEAR(ours.variation, largest, 1e-12) << "pixel " << k;
  }
}

TEST(DeepFlatten, OrderOfSamplesDoesNotMatter) {
  std::mt19937 random(2);
  FlattenScratch scratch;
  for (int k = 0; k < 300; ++k) {
    std::vector<DeepSample> samples;
    for (const Piece& piece : random_pixel(random, 9, true)) {
      samples.push_back(sample_of(piece, samples.size()));
      // Points in one place lie as they are stored.
      if (piece.back == piece.front) samples.back().front = samples.back().back += 0.001 * double(samples.size());
    }
    std::vector<DeepSample> shuffled = samples;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const FlatPixel a = flatten(samples, false, LayerRule::variation, scratch);
    const FlatPixel b = flatten(shuffled, false, LayerRule::variation, scratch);
    EXPECT_EQ(a.color, b.color);
    EXPECT_EQ(a.winner, b.winner);
  }
}

TEST(DeepFlatten, CuttingAVolumeChangesNothing) {
  std::mt19937 random(3);
  FlattenScratch scratch;
  for (int k = 0; k < 300; ++k) {
    std::vector<Piece> pieces = random_pixel(random, 7, true);
    const FlatPixel whole = flatten_pieces(pieces, scratch);
    pieces.push_back({0.5 + double(k % 15), 0.5 + double(k % 15), 0, 0, {}});  // a point that is not there
    pieces.push_back({0, 30, 0, 0, {}});
    const FlatPixel cut = flatten_pieces(pieces, scratch);
    EXPECT_NEAR(cut.color.r, whole.color.r, 1e-12 * (1 + whole.color.r));
    EXPECT_NEAR(cut.variation, whole.variation, 1e-12);
  }
}

TEST(DeepFlatten, ManyThinSamplesKeepTheirTransmittance) {
  for (const double thickness : {0.0, 1.0}) {
    std::vector<Piece> pieces;
    for (int i = 0; i < 2000; ++i) pieces.push_back({double(i), i + thickness, 0.02, 0, {}});
    pieces.push_back({5000, 5000, 1, 1, {}});
    EXPECT_NEAR(flatten_pieces(pieces).color.r / std::pow(0.98, 2000), 1, 1e-9);  // 2.83e-18
  }
}

TEST(DeepFlatten, LightScalesExactly) {
  std::mt19937 random(4);
  for (int k = 0; k < 100; ++k) {
    std::vector<Piece> pieces = random_pixel(random, 8, true);
    const FlatPixel once = flatten_pieces(pieces);
    for (Piece& piece : pieces) piece.color = std::ldexp(piece.color, 40);
    EXPECT_EQ(std::ldexp(once.color.r, 40), flatten_pieces(pieces).color.r);
  }
}

TEST(DeepFlatten, OneSampleGivesItselfToFloatPrecision) {
  for (const float alpha : {0.0f, 1e-7f, 0.02f, 0.3999f, 0.99999994f, 1.0f})
    for (const double back : {1.0, 1.0000001, 1e30}) {
      const FlatPixel flat = flatten_pieces({{1, back, double(alpha), double(0.1f), {}}});
      EXPECT_EQ(float(flat.color.r), 0.1f) << alpha << " to " << back;
      EXPECT_EQ(float(flat.color.a), alpha) << alpha << " to " << back;
    }
}

TEST(DeepFlatten, TiesGoToTheFrontAndLightHasItsOwnRule) {
  FlattenScratch scratch;
  EXPECT_EQ(flatten_pieces({{5, 5, 1, 0, {}}, {2, 2, 0.5, 0, {}}}, scratch).winner, 1u);
  const std::vector<Piece> flame = {{3, 3, 0.9, 0.1, {}}, {2, 2, 0, 4, {}}};
  EXPECT_EQ(flatten_pieces(flame, scratch).winner, 0u);
  EXPECT_EQ(flatten_pieces(flame, scratch, LayerRule::contribution).winner, 1u);
  // Three thin slices of one thing against one sample: each slice is a sample of its own.
  EXPECT_EQ(flatten_pieces({{4, 4, 1, 0, {}}, {1, 1, 0.2, 0, {}}, {2, 2, 0.2, 0, {}}}, scratch).winner, 0u);
}

TEST(DeepFlatten, ColoredOpacityIsPerChannel) {
  DeepSample front, behind;
  front.front = front.back = 1;
  front.opacity = glm::dvec4(1, 0.5, 0, 0.5);
  front.index = 0;
  behind.front = behind.back = 2;
  behind.opacity = glm::dvec4(1);
  behind.color = glm::dvec4(1, 1, 1, 0);
  behind.index = 1;
  std::vector<DeepSample> samples = {behind, front};
  FlattenScratch scratch;
  const FlatPixel flat = flatten(samples, true, LayerRule::variation, scratch);
  EXPECT_EQ(flat.color, glm::dvec4(0, 0.5, 1, 1));
  EXPECT_EQ(flat.winner, 0u);  // .2126 + .3576 against .3576 + .0722
}

TEST(DeepRepair, BadSamplesStayWithinTheirPixel) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  DeepDefects defects;
  const auto repaired = [&](double front, double back, double alpha) {
    DeepSample sample = sample_of({front, back, alpha, 1, {}});
    const bool kept = repair(sample, defects);
    EXPECT_EQ(kept, front == front);
    return sample;
  };
  repaired(nan, 1, 0.5);
  EXPECT_EQ(defects.dropped, 1u);
  EXPECT_EQ(repaired(5, 0, 0.5).back, 5);  // ZBack never written
  EXPECT_EQ(repaired(5, nan, 0.5).back, 5);
  EXPECT_EQ(repaired(5, inf, 0.5).back, 5);
  EXPECT_EQ(defects.turned, 3u);
  EXPECT_EQ(repaired(5, 5, 1.5).opacity.a, 1);
  EXPECT_EQ(repaired(5, 5, -1).opacity.a, 0);
  EXPECT_NE(repaired(5, 5, nan).color.r, repaired(5, 5, 0).color.g);  // NaN: the pixel is repaired from its neighbors
  EXPECT_EQ(defects.opacity, 3u);
  // A color that is not finite does not show through what hides it.
  EXPECT_EQ(flatten_pieces({{1, 1, 1, 0.5, {}}, {2, 2, 1, nan, {}}, {1, 3, 1, nan, {}}}).color.r, 0.5);
  EXPECT_FALSE(std::isfinite(flatten_pieces({{1, 1, 0.5, 0.5, {}}, {2, 2, 1, nan, {}}}).color.r));
}

TEST(DeepFlatten, OverlapsCostNoMoreThanSorting) {
  // Every sample overlaps every other: pieces would be 10^10.
  std::vector<Piece> pieces;
  for (int i = 0; i < 100000; ++i) pieces.push_back({double(i), 1e6 + i, 1e-5, 1e-5, {}});
  const FlatPixel flat = flatten_pieces(pieces);
  EXPECT_NEAR(flat.color.a, -std::expm1(100000 * std::log1p(-1e-5)), 1e-9);
  EXPECT_NEAR(flat.color.r, flat.color.a, 1e-9);
}

}  // namespace
}  // namespace varve::test
