// Layers over each other: the slow twin, and the laws of over, of the winning layer and of transmittance.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "layers/composite.h"
#include "layers/over.h"
#include "layers/transmittance.h"
#include "reference/layers_reference.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::flat_present;
using test::same_bits;

constexpr Window kOdd{-3, 2, 20, 15};

/// A layer that covers some pixels, some by half; every plane that a present can have.
Present layer_of(const Window& w, unsigned seed, Workers& workers, bool colored = false) {
  Present p = test::noise_present(w, {.seed = seed, .motion = 3, .with_depth = true, .with_marks = true}, workers);
  std::mt19937 random(seed + 77);
  std::uniform_real_distribution<float> unit(0, 1);
  if (colored) p.transmittance = Plane<glm::vec3>(w);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const float kind = unit(random), alpha = kind < 0.3f ? 0.0f : kind < 0.6f ? 1.0f : unit(random);
      glm::vec4& c = p.color.at(x, y);
      c = kind < 0.2f ? glm::vec4(0.0f) : glm::vec4(c.x * alpha, c.y * alpha, c.z * alpha, alpha);
      if (kind > 0.95f) c.w = 0;  // shines
      if (colored) p.transmittance.at(x, y) = glm::vec3(1 - c.w, unit(random), 1 - 0.5f * c.w);
    }
  return p;
}

std::vector<const Present*> pointers(const std::vector<Present>& layers) {
  std::vector<const Present*> all;
  for (const Present& layer : layers) all.push_back(&layer);
  return all;
}

Present composite(const std::vector<Present>& layers, Workers& workers, LayerRule rule = LayerRule::variation) {
  return composite_presents(pointers(layers), Window{}, rule, true, workers);
}

std::vector<Present> four_layers(Workers& workers) {
  std::vector<Present> layers;
  layers.push_back(layer_of(kOdd, 1, workers));
  layers.push_back(layer_of({2, 0, 9, 9}, 2, workers, true));  // another window
  layers.push_back(layer_of(kOdd, 3, workers));
  layers.push_back(layer_of({-10, 5, 12, 30}, 4, workers));
  return layers;
}

TEST(Layers, CompositeIsThatOfTheSlowTwin) {
  Workers workers(2);
  const std::vector<Present> layers = four_layers(workers);
  for (const LayerRule rule : {LayerRule::variation, LayerRule::contribution}) {
    const Present out = composite(layers, workers, rule);
    const Window all{-10, 0, 20, 30};
    ASSERT_TRUE(out.color.window() == all);
    for (int y = all.y0; y < all.y1; ++y)
      for (int x = all.x0; x < all.x1; ++x) {
        const reference::StackedPixel twin = reference::stacked_pixel(pointers(layers), rule, x, y);
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(double(out.color.at(x, y)[k]), twin.color[k], 1e-6 * std::max(1.0, std::abs(twin.color[k])));
        ASSERT_EQ(int(out.combined.winner.at(x, y)), twin.winner) << x << " " << y;
        ASSERT_NEAR(double(out.combined.variation.at(x, y)), twin.variation, 1e-6);
        ASSERT_EQ(int(out.combined.touched.at(x, y)), twin.touched);
        if (twin.winner == 0) continue;
        const Present& lends = layers[std::size_t(twin.winner - 1)];
        EXPECT_EQ(out.motion.at(x, y), lends.motion.at(x, y));
        EXPECT_EQ(out.depth.at(x, y), lends.depth.at(x, y));
        EXPECT_EQ(out.id.at(x, y), lends.id.at(x, y));
        EXPECT_EQ(out.normal.at(x, y), lends.normal.at(x, y));
      }
  }
}

TEST(Layers, TwoThousandThinLayersStayAccurate) {
  Over over;
  for (int k = 0; k < 2000; ++k) over.add(glm::dvec3(0.02), glm::dvec3(1 - 0.02));
  const double exact = double(std::pow(0.98L, 2000.0L));
  EXPECT_NEAR(over.transmittance().x / exact, 1, 1e-12);
  EXPECT_NEAR(over.light().y, 1, 1e-12);
  // The same with alphas as files hold them: what one minus the accumulated alpha gives is off by twelve magnitudes.
  Over stored;
  float accumulated = 0;
  for (int k = 0; k < 2000; ++k) {
    stored.add(glm::dvec3(0.0), glm::dvec3(1 - double(0.02f)));
    accumulated += (1 - accumulated) * 0.02f;
  }
  EXPECT_NEAR(stored.transmittance().x / double(std::pow(1.0L - 0.02f, 2000.0L)), 1, 1e-12);
  EXPECT_GT(double(1 - accumulated), 1e6 * exact);
}

TEST(Layers, TheGreatestChangeOfTransmittanceWinsAndTiesGoToTheFront) {
  Workers workers(1);
  const Window w{0, 0, 3, 3};
  const auto winner = [&](std::initializer_list<float> alphas) {
    std::vector<Present> layers;
    for (const float a : alphas) layers.push_back(flat_present(w, glm::vec4(a * 0.5f, a * 0.5f, a * 0.5f, a), workers));
    return int(composite(layers, workers).combined.winner.at(1, 1));
  };
  EXPECT_EQ(winner({0.4f, 0.8f}), 2);    // 0.4, 0.48, background 0.12
  EXPECT_EQ(winner({0.5f, 0.8f}), 1);    // 0.5, 0.4
  EXPECT_EQ(winner({0.5f, 1.0f}), 1);    // 0.5, 0.5: the nearer
  EXPECT_EQ(winner({0.5f, 0.0f}), 1);    // 0.5 and the background's 0.5
  EXPECT_EQ(winner({0.25f, 0.25f}), 0);  // the background is seen through more than either
  EXPECT_EQ(winner({0.0f, 0.0f}), 0);
  EXPECT_EQ(winner({0.2f, 0.2f, 1.0f}), 3);
}

TEST(Layers, WhatShinesWithoutCoveringIsFollowedUnderTheContributionRule) {
  Workers workers(1);
  const Window w{0, 0, 5, 4};
  std::vector<Present> layers;
  layers.push_back(flat_present(w, glm::vec4(3, 3, 3, 0), workers));  // a flame
  layers.push_back(flat_present(w, glm::vec4(0.5f, 0.5f, 0.5f, 1), workers));
  EXPECT_EQ(composite(layers, workers).combined.winner.at(2, 2), 2);
  EXPECT_EQ(composite(layers, workers, LayerRule::contribution).combined.winner.at(2, 2), 1);
  EXPECT_EQ(composite(layers, workers).color.at(2, 2), glm::vec4(3.5f, 3.5f, 3.5f, 1));
}

TEST(Layers, ScaledByPowersOfTwoBitForBit) {
  Workers workers(1);
  const std::vector<Present> layers = four_layers(workers);
  const Present plain = composite(layers, workers);
  for (const float factor : {std::ldexp(1.0f, 20), std::ldexp(1.0f, -20)}) {
    std::vector<Present> scaled = four_layers(workers);
    for (Present& layer : scaled)
      for (int y = layer.color.window().y0; y < layer.color.window().y1; ++y)
        for (int x = layer.color.window().x0; x < layer.color.window().x1; ++x) {
          glm::vec4& c = layer.color.at(x, y);
          c = glm::vec4(c.x * factor, c.y * factor, c.z * factor, c.w);
        }
    const Present out = composite(scaled, workers);
    for (int y = 0; y < 15; ++y)
      for (int x = -3; x < 20; ++x) {
        const glm::vec4 &a = out.color.at(x, y), &b = plain.color.at(x, y);
        ASSERT_EQ(a, glm::vec4(b.x * factor, b.y * factor, b.z * factor, b.w));
        ASSERT_EQ(out.combined.winner.at(x, y), plain.combined.winner.at(x, y));
      }
  }
}

TEST(Layers, AnOpaqueLayerIsItselfWhateverLiesBehind) {
  Workers workers(1);
  std::vector<Present> layers;
  layers.push_back(flat_present(kOdd, glm::vec4(0.3f, -0.7f, 65504.0f, 1), workers));
  layers.push_back(flat_present(kOdd, glm::vec4(1e30f, 1e-40f, 5, 1), workers));
  const Present out = composite(layers, workers);
  for (int x = -3; x < 20; ++x) ASSERT_EQ(out.color.at(x, 7), glm::vec4(0.3f, -0.7f, 65504.0f, 1));
}

TEST(Layers, EmptyLayersChangeNoBit) {
  Workers workers(1);
  const Window w{0, 0, 9, 7};
  const Present alone = layer_of(w, 5, workers);
  std::vector<Present> layers;
  layers.push_back(flat_present(w, glm::vec4(0.0f), workers));
  layers.push_back(layer_of(w, 5, workers));
  layers.push_back(flat_present(w, glm::vec4(0.0f), workers));
  const Present out = composite(layers, workers);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      ASSERT_EQ(glm::vec3(out.color.at(x, y)), glm::vec3(alone.color.at(x, y)));
      ASSERT_NEAR(out.color.at(x, y).w, alone.color.at(x, y).w, 1e-7f);
    }
}

TEST(Layers, ThreadsChangeNoBit) {
  Workers one(1), three(3);
  EXPECT_TRUE(same_bits(composite(four_layers(one), one).color, composite(four_layers(three), three).color));
}

TEST(Layers, BadPixelsOfALayerTouchTheirOwnFootprintOnly) {
  Workers workers(1);
  const Window w{0, 0, 9, 9};
  std::vector<Present> layers;
  layers.push_back(flat_present(w, glm::vec4(0.25f, 0.25f, 0.25f, 0.5f), workers));
  layers.push_back(flat_present(w, glm::vec4(1, 1, 1, 1), workers));
  const Present clean = composite(layers, workers);
  layers[0].color.at(4, 4).x = std::numeric_limits<float>::quiet_NaN();
  layers[0].color.at(6, 2).w = std::numeric_limits<float>::infinity();
  sanitize(layers[0], workers);
  const Present out = composite(layers, workers);
  EXPECT_EQ(out.not_finite, 2u);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) {
      const bool bad = (x == 4 && y == 4) || (x == 6 && y == 2);
      EXPECT_EQ(out.valid.at(x, y), bad ? 0.0f : 1.0f);
      EXPECT_EQ(out.color.at(x, y), clean.color.at(x, y));  // repaired from equal neighbors
    }
  EXPECT_EQ(out.rows_valid[4], 0);
  EXPECT_EQ(out.rows_valid[5], 1);
  // Hidden, it has no say.
  std::swap(layers[0], layers[1]);
  EXPECT_EQ(composite(layers, workers).valid.at(4, 4), 1.0f);
}

TEST(Layers, AlphaAndTransmittanceAreHeldAndCounted) {
  Workers workers(1);
  const Window w{0, 0, 4, 1};
  Present p = flat_present(w, glm::vec4(0.5f, 0.5f, 0.5f, 0.5f), workers);
  p.color.at(0, 0).w = 1.5f;
  p.color.at(1, 0).w = -0.25f;
  p.transmittance = Plane<glm::vec3>(w, 0, glm::vec3(0.5f));
  p.transmittance.at(2, 0) = glm::vec3(2, -1, std::numeric_limits<float>::quiet_NaN());
  hold_opacity(p, workers);
  EXPECT_EQ(p.opacity_held, 3u);
  EXPECT_EQ(p.color.at(0, 0).w, 1.0f);
  EXPECT_EQ(p.color.at(1, 0).w, 0.0f);
  EXPECT_EQ(p.transmittance.at(2, 0), glm::vec3(1, 0, 0.5f));  // the last from alpha
  EXPECT_EQ(p.transmittance.at(3, 0), glm::vec3(0.5f));
}

TEST(Layers, CumulativeTransmittanceIsThatOfEachLayerMultiplied) {
  Workers workers(1);
  const std::vector<Present> plain = four_layers(workers);
  std::vector<Present> layers = four_layers(workers);
  for (const std::size_t k : {1u, 2u}) {  // hold what all layers up to themselves let through
    const Window w = layers[k].color.window();
    layers[k].transmittance = Plane<glm::vec3>(w);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        glm::dvec3 through(1.0);
        for (std::size_t i = 0; i <= k; ++i)
          if (plain[i].color.window().contains(x, y)) through *= transmittance_at(plain[i], x, y);
        layers[k].transmittance.at(x, y) = glm::vec3(through);
      }
  }
  separate_transmittance(layers, {false, true, true, false}, workers);
  const Present out = composite(layers, workers), apart = composite(plain, workers);
  const Window w = out.color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      for (int k = 0; k < 4; ++k)
        ASSERT_NEAR(out.color.at(x, y)[k], apart.color.at(x, y)[k], 2e-6f * std::max(1.0f, apart.color.at(x, y)[k]));
}

/// The known bias of layers resolved apart (E[a1 c2] is not E[a1] E[c2]): two layers that share an edge, each pixel
/// being covered by one or the other.
TEST(Layers, CompositeOfMeansLosesTheCovariance) {
  Workers workers(1);
  const Window w{0, 0, 1, 1};
  const Plane<glm::vec4> half(w, 0, glm::vec4(0.5f));  // mean of covered and not covered, of both layers
  const LayerColor layers[] = {{&half, nullptr}, {&half, nullptr}};
  const Plane<glm::vec4> each = composite_colors(layers, w, workers);
  EXPECT_EQ(each.at(0, 0), glm::vec4(0.75f));  // the truth is 1: whatever one leaves the other fills
}

TEST(Layers, ColorWithoutCoverageGoesUnlessItShines) {
  Workers workers(1);
  const Window w{0, 0, 9, 3};
  Present p = flat_present(w, glm::vec4(0.0f), workers);
  p.color.at(7, 1) = glm::vec4(2, 2, 2, 0);
  Plane<glm::vec4> resolved(w, 0, glm::vec4(0.5f, 0.5f, 0.5f, -0.01f));
  hold_resolved(resolved, p, workers);
  EXPECT_EQ(resolved.at(2, 1), glm::vec4(0.0f));
  EXPECT_EQ(resolved.at(6, 1), glm::vec4(0.5f, 0.5f, 0.5f, 0.0f));
}

}  // namespace
}  // namespace varve
