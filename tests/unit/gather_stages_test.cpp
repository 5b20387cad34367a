// The stages of the gather by themselves: vectors that are chained, turned round and checked; light that is compared.
#include <gtest/gtest.h>

#include <random>

#include "gather/carry.h"
#include "gather/noise_share.h"
#include "gather/opposite_vectors.h"
#include "gather/round_trip.h"
#include "gather/temporal_change.h"
#include "support/gather_scenes.h"

namespace varve {
namespace {

using test::Seen;
using test::Shot;
using test::take;
using test::TwoPlanes;

template <class F>
void each_pixel(const Window& w, const F& f) {
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) f(x, y);
}

/// The picture turns and grows around a point: where what was at `p` in frame 0 is in a frame, and back.
struct Turn {
  glm::dvec2 center{18, 13}, drift{0.4, -0.3};
  double angle = 0.013, zoom = 1.006;
  glm::dvec2 turned(glm::dvec2 d, double frames) const {
    const double s = std::pow(zoom, frames), c = std::cos(angle * frames), n = std::sin(angle * frames);
    return glm::dvec2(c * d.x - n * d.y, n * d.x + c * d.y) * s;
  }
  /// Of a point seen in one frame, in another.
  glm::dvec2 moved(glm::dvec2 at, int from, int to) const {
    return center + drift * double(to) + turned(at - center - drift * double(from), to - from);
  }
  Seen operator()(glm::dvec2 at, int f) const {
    return {test::texture(at), 1, 10, moved(at, f, f - 1) - at, moved(at, f, f + 1) - at};
  }
};

/// Greatest distance between where samples are carried and where they are, over 16 frames on each side.
double worst_carried(bool with_beyond, Workers& workers) {
  const Turn world;
  const int frames = 33, present = 16;
  const Shot shot = take(world, {.frames = frames, .window = {-4, 3, 37, 32}}, workers);
  const std::vector<GatherSource> sources = shot.sources();
  std::vector<Carried> fields(frames);
  fields[present] = carry_present(sources[present], workers);
  double worst = 0;
  const auto step = [&](int i, int toward) {
    const auto at = [&](int k) { return Followed{&sources[std::size_t(k)], &fields[std::size_t(k)]}; };
    const int beyond = i + 2 * toward;
    const bool known = with_beyond && (toward > 0 ? beyond <= present : beyond >= present);
    fields[std::size_t(i)] = carry(sources[std::size_t(i)], toward > 0, shot.test(), at(i + toward),
                                   known ? at(beyond) : Followed{}, workers);
    int followed = 0;
    const Window& w = sources[std::size_t(i)].window();
    each_pixel(w, [&](int x, int y) {
      const glm::vec3 d = fields[std::size_t(i)].at(x, y);
      if (!(d.x == d.x)) return;
      ++followed;
      const glm::dvec2 from = sources[std::size_t(i)].position(x, y);
      const glm::dvec2 off = from + glm::dvec2(d) - world.moved(from, i, present);
      worst = std::max({worst, std::fabs(off.x), std::fabs(off.y)});
      EXPECT_EQ(d.z, 10.0f);
    });
    EXPECT_GT(followed, w.width() * w.height() / 2) << i;
  };
  for (int i = present + 1; i < frames; ++i) step(i, -1);
  for (int i = present; i-- > 0;) step(i, 1);
  return worst;
}

TEST(Carry, FollowsRotationAndZoom) {
  Workers workers(2);
  const double worst = worst_carried(false, workers), beyond = worst_carried(true, workers);
  EXPECT_LT(worst, 1e-4);
  EXPECT_LT(beyond, 0.03);  // a doubled vector leaves the circle
  RecordProperty("worst", std::to_string(worst));
}

TEST(Carry, ThinThingsAndEdgesKeepTheirOwnMotion) {
  Workers workers(2);
  // A bar about one sample wide in front of a plane that goes the other way.
  const glm::dvec2 bar_speed(1.3, 0.2), back_speed(-0.7, 0.1);
  const test::World world = [&](glm::dvec2 at, int f) {
    const double along = at.x - bar_speed.x * f;
    if (along > 9 && along < 10.1) return Seen{glm::vec4(1), 2, 5, -bar_speed, bar_speed};
    return Seen{glm::vec4(0), 1, 20, -back_speed, back_speed};
  };
  const Shot shot = take(world, {.frames = 9}, workers);
  const std::vector<GatherSource> sources = shot.sources();
  std::vector<Carried> fields(9);
  fields[8] = carry_present(sources[8], workers);
  int bar = 0;
  for (std::size_t i = 8; i-- > 0;) {
    fields[i] = carry(sources[i], true, shot.test(), {&sources[i + 1], &fields[i + 1]},
                      i < 7 ? Followed{&sources[i + 2], &fields[i + 2]} : Followed{}, workers);
    each_pixel(sources[i].window(), [&](int x, int y) {
      const glm::vec3 d = fields[i].at(x, y);
      if (!(d.x == d.x)) return;
      const bool front = shot.presents[i].id.at(x, y) == 2;
      const glm::dvec2 truth = (front ? bar_speed : back_speed) * double(8 - i);
      EXPECT_NEAR(d.x, truth.x, 1e-4) << i << ": " << x << "," << y;
      EXPECT_NEAR(d.y, truth.y, 1e-4);
      bar += front;
    });
  }
  EXPECT_GT(bar, 7 * 20);
}

TEST(OppositeVectors, InvertASmoothField) {
  Workers workers(2);
  // From a frame's position to that in the frame before: bends by up to a tenth of a pixel a pixel.
  const auto before = [](glm::dvec2 p) {
    return p + glm::dvec2(1.7 + 0.8 * std::sin(0.12 * p.y), -0.6 + 0.7 * std::sin(0.1 * p.x + 0.2));
  };
  const auto after = [&](glm::dvec2 p) {
    glm::dvec2 q = p;
    for (int i = 0; i < 100; ++i) q -= before(q) - p;
    return q;
  };
  const test::World world = [&](glm::dvec2 at, int) {
    return Seen{test::texture(at), 1, 10, before(at) - at, after(at) - at};
  };
  const Shot shot = take(world, {.frames = 2, .window = {0, 0, 61, 47}}, workers);
  const std::vector<GatherSource> s = shot.sources();
  const Plane<glm::vec2> made = opposite_vectors(s[0], s[1], shot.backward[1], shot.test(), 0.05, workers);
  double worst = 0;
  each_pixel(Window{4, 4, 57, 43}, [&](int x, int y) {
    const glm::vec2 off = made.at(x, y) - shot.forward[0].at(x, y);
    ASSERT_TRUE(off.x == off.x) << x << "," << y;
    worst = std::max({worst, std::fabs(double(off.x)), std::fabs(double(off.y))});
  });
  // What bilinear reading of a field that bends leaves: an eighth of its second derivative.
  EXPECT_LT(worst, 2e-3);
  RecordProperty("worst", std::to_string(worst));
}

TEST(OppositeVectors, SayNothingOfWhatIsHidden) {
  Workers workers(2);
  TwoPlanes world;
  world.front_speed = {6, 0};
  world.back_speed = {-1, 0.5};
  const Shot shot = take(world, {.frames = 2, .window = {0, 0, 50, 30}}, workers);
  const std::vector<GatherSource> s = shot.sources();
  const Plane<glm::vec2> made = opposite_vectors(s[0], s[1], shot.backward[1], shot.test(), 0.05, workers);
  int hidden = 0, seen = 0;
  each_pixel(Window{8, 2, 42, 28}, [&](int x, int y) {
    const glm::dvec2 at = s[0].position(x, y);
    const glm::vec2 v = made.at(x, y);
    if (world.covers(at, 0)) {
      EXPECT_NEAR(v.x, 6, 1e-3);
      EXPECT_NEAR(v.y, 0, 1e-3);
    } else if (world.covers(at + world.back_speed + glm::dvec2(3, 0), 1)) {  // three pixels under the edge
      EXPECT_FALSE(v.x == v.x) << x << "," << y;
      ++hidden;
    } else if (!world.covers(at + world.back_speed - glm::dvec2(1, 0), 1)) {
      EXPECT_NEAR(v.x, -1, 1e-3) << x << "," << y;
      EXPECT_NEAR(v.y, 0.5, 1e-3);
      ++seen;
    }
  });
  EXPECT_GT(hidden, 30);
  EXPECT_GT(seen, 200);
}

TEST(TrustedVectors, DropTheWrongOnes) {
  Workers workers(2);
  const Turn world;
  Shot shot = take(world, {.frames = 2}, workers);
  std::mt19937 random(2);
  Plane<float> wrong(shot.presents[0].color.window(), 0, 0.0f);
  Plane<glm::vec2> vectors = shot.forward[0].clone();
  each_pixel(wrong.window(), [&](int x, int y) {
    if (random() % 20 != 0) return;
    wrong.at(x, y) = 1;
    vectors.at(x, y) += random() % 2 ? glm::vec2(3, 0) : glm::vec2(0.2, -0.3);
  });
  const std::vector<GatherSource> s = shot.sources();
  const Plane<glm::vec2> kept = trusted_vectors(s[0], vectors, s[1], shot.backward[1], shot.test(), 0.1, workers);
  int dropped = 0;
  each_pixel(Window{3, 3, 33, 26}, [&](int x, int y) {
    const bool gone = !(kept.at(x, y).x == kept.at(x, y).x);
    EXPECT_EQ(gone, wrong.at(x, y) > 0) << x << "," << y;
    EXPECT_TRUE(gone || kept.at(x, y) == vectors.at(x, y));
    dropped += gone;
  });
  EXPECT_GT(dropped, 10);
  // The plane that is shown: how far they miss.
  Plane<float> miss(wrong.window(), 0, 0.0f);
  measure_round_trip(s[1], s[0], shot.test(), miss, workers);
  each_pixel(Window{3, 3, 33, 26}, [&](int x, int y) { EXPECT_LT(miss.at(x, y), 1e-4); });
}

TEST(ShadingGain, FollowsLightAndLeavesNoiseAlone) {
  Workers workers(2);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> noise(0.9f, 1.1f);
  const float lights[] = {1, 1.06f, 2, 0.25f};
  Shot shot = take(
      [&](glm::dvec2, int f) {
        return Seen{glm::vec4(lights[f] * noise(random)), 1, 10, {}, {}};
      },
      {.frames = 4}, workers);
  shot.measure_light(15, workers);
  shot.range.clear();
  std::vector<GatherSource> s;
  for (std::size_t i = 0; i < 4; ++i) {
    GatherSource one;
    one.present = &shot.presents[i], one.jitter = shot.jitter[i], one.local_light = &shot.light[i];
    s.push_back(one);
  }
  each_pixel(s[0].window(), [&](int x, int y) {
    const glm::dvec2 at(x + 0.5, y + 0.5);
    const auto gain = [&](std::size_t from) {
      return shading_gain(s[from], x, y, s[0], at, {1, 10}, shot.test(), 0.1, 0.05);
    };
    EXPECT_EQ(gain(1).gain, 1);
    EXPECT_EQ(gain(1).weight, 1);
    EXPECT_NEAR(gain(2).gain, 0.52, 0.02);  // 1/2, shrunk by a 25th of the change
    EXPECT_NEAR(gain(3).gain, 4, 0.12);
    EXPECT_LT(gain(2).weight, 0.01);
    EXPECT_LT(gain(3).weight, gain(2).weight);
  });
}

TEST(LocalLight, DoesNotLeakAcrossEdges) {
  Workers workers(2);
  TwoPlanes world;
  world.front = [](glm::dvec2) { return glm::vec4(8); };
  world.back = [](glm::dvec2) { return glm::vec4(0.5f); };
  const Shot shot = take(world, {.frames = 1}, workers);
  const Present& p = shot.presents[0];
  const Plane<float> light = local_light(p.color, p, shot.test(), 9, workers);
  each_pixel(light.window(), [&](int x, int y) {
    EXPECT_NEAR(light.at(x, y), p.id.at(x, y) == 7 ? 8.0f : 0.5f, 1e-5f) << x << "," << y;
  });
}

class Change : public testing::Test {
 protected:
  /// Weights of the near and the far frames after the test, for their lights; frames 16 +- 1 and 16 - 8..15.
  std::pair<double, double> turned(const std::function<float()>& near, const std::function<float()>& far,
                                   double limit = 3) {
    std::vector<Arrival> arrivals;
    for (std::uint32_t f = 1; f <= 8; ++f) arrivals.push_back({0, 0, 0, 1, 1, far(), 0, 0, f});
    for (std::uint32_t f = 15; f <= 17; ++f)
      for (int k = 0; k < 2; ++k) arrivals.push_back({0, 0, 0, 1, 1, near(), 0, 0, f});
    std::vector<const Arrival*> list;
    for (const Arrival& a : arrivals) list.push_back(&a);
    std::vector<float> weights(list.size(), 1);
    turn_down_changed(list, 16, 1, limit, weights.data());
    return {double(weights.back()), double(weights.front())};
  }
  std::mt19937 random{4};
  std::uniform_real_distribution<float> spread{0.8f, 1.2f};
};

TEST_F(Change, AFlashInFarFramesIsTurnedDown) {
  const auto [near, far] = turned([&] { return spread(random); }, [&] { return 10 * spread(random); });
  EXPECT_EQ(near, 1);
  EXPECT_LT(far, 0.5);
  const auto [flat_near, flat_far] = turned([] { return 1.0f; }, [] { return 1.5f; });
  EXPECT_EQ(flat_near, 1);
  EXPECT_LT(flat_far, 1e-5);
  EXPECT_GT(flat_far, 0);
  EXPECT_EQ(turned([] { return 1.0f; }, [] { return 1.5f; }, 0).second, 1);
}

TEST_F(Change, TextureIsLeftAlone) {
  int kept = 0;
  for (int i = 0; i < 200; ++i)
    kept += turned([&] { return spread(random) > 1 ? 4.0f : 0.1f; }, [&] { return spread(random) > 1 ? 4.0f : 0.1f; })
                .second == 1;
  EXPECT_GT(kept, 190);
  EXPECT_EQ(turned([] { return 0.7f; }, [] { return 0.7f; }).second, 1);
}

}  // namespace
TEST(GatherStages, NoiseIsToldFromDetail) {
  // A pixel crossed by an edge: samples in the same quarter agree. And the same places with values at random.
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Arrival> edge, noise;
  for (int bin = 0; bin < 16; ++bin)
    for (int k = 0; k < 3; ++k) {
      Arrival a{};
      a.x = (float(bin % 4) + unit(random)) / 4, a.y = (float(bin / 4) + unit(random)) / 4;
      a.light = bin % 4 < 2 ? 0.1f : 0.9f;
      edge.push_back(a);
      a.light = unit(random);
      noise.push_back(a);
    }
  const auto share = [](const std::vector<Arrival>& list) {
    std::vector<const Arrival*> pointers;
    for (const Arrival& a : list) pointers.push_back(&a);
    return noise_share(pointers);
  };
  EXPECT_LT(share(edge), 1e-6);
  EXPECT_GT(share(noise), 0.7);
  EXPECT_LT(share(noise), 1.3);
  EXPECT_EQ(share({edge.begin(), edge.begin() + 4}), 0);  // too few to tell
}

TEST(GatherStages, SuddenLightIsFollowedAndNoiseIsNot) {
  // The pilot is the mean of three frames; the own samples are noisy, and on the right twice as bright as it knows.
  Workers workers(2);
  const Window w{0, 0, 61, 33};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.5f, 1.5f);
  Present present;
  present.color = Plane<glm::vec4>(w, kPresentBorder, glm::vec4(0));
  Plane<glm::vec4> pilot(w, 0, glm::vec4(1));
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      present.color.at(x, y) = glm::vec4(glm::vec3(unit(random) * (x < 30 ? 1.0f : 2.0f)), 1);
  sanitize(present, workers);
  const SurfaceTest test = surface_test(present);
  Plane<float> light = local_light(pilot, present, test, 15, workers);
  follow_sudden_light(light, pilot, present, test, 15, workers);
  EXPECT_EQ(light.at(8, 16), 1.0f);  // noise alone changes nothing
  EXPECT_NEAR(light.at(50, 16), 2.0, 0.1);
}

}  // namespace varve
