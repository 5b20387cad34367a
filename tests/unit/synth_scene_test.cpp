// Laws of the analytic scenes: motion leads to the same point of the same thing, layers add up, chance has its share.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "paths.h"
#include "synth/hash.h"
#include "synth/render.h"
#include "synth/scenes.h"

namespace varve::synth {
namespace {

constexpr int kWidth = 320, kHeight = 180;

Moment at(const Scene& scene, int frame, std::optional<Layer> layer = std::nullopt) {
  return moment_of(scene, frame, kWidth, kHeight, layer);
}

/// Random positions in the picture.
template <class Visit>
void visit_positions(int count, std::uint64_t seed, Visit visit) {
  for (int i = 0; i < count; ++i) {
    const std::uint64_t key = mix(seed, std::uint64_t(i));
    visit(kWidth * uniform(mix(key, 1)), kHeight * uniform(mix(key, 2)));
  }
}

struct Followed {
  int visible = 0, hidden = 0, lost = 0;
};

/// Follows the vectors of `here` into the frame beside it and looks what is there.
void follow(const Moment& here, const Moment& there, bool backward, std::uint64_t seed, Followed& count) {
  visit_positions(400, seed, [&](double x, double y) {
    const Sample p = evaluate(here, x, y);
    if (!p.surface) return;
    const glm::dvec2 way = backward ? p.backward : p.forward;
    const double depth = backward ? p.depth_before : p.depth_after;
    if (!(depth > 0)) return;
    const Sample q = evaluate(there, x + way.x, y + way.y);
    const bool sky = p.surface->outline == Outline::sky;
    const double expected = sky ? kFarDepth : depth;
    if (q.depth < expected * (1 - 1e-9)) {
      ++count.hidden;
    } else if (q.id != p.id) {
      ++count.lost;  // a rim missed by rounding
    } else {
      ++count.visible;
      ASSERT_NEAR(q.depth / expected, 1, 1e-9) << p.surface->name;
      ASSERT_NEAR(q.material.x, p.material.x, 1e-6) << p.surface->name;
      ASSERT_NEAR(q.material.y, p.material.y, 1e-6) << p.surface->name;
    }
  });
}

TEST(SynthMotion, LeadsToTheSamePointOfTheSameThing) {
  for (const SceneRow& row : scene_table()) {
    const Scene scene = make_scene(row.name);
    if (!scene.right_vectors) continue;
    Followed count;
    for (const int frame : {2, 13, 24, 25, 31, 48})
      for (const int step : {-1, 1}) {
        if (&shot_of(scene, frame) != &shot_of(scene, frame + step)) continue;
        follow(at(scene, frame), at(scene, frame + step), step < 0, std::uint64_t(frame), count);
      }
    EXPECT_GT(count.visible, 1500) << row.name;
    EXPECT_LE(count.lost, 2) << row.name;
  }
}

TEST(SynthMotion, ZoomRotationAndTeleportAreNoEmptyClaims) {
  const auto longest = [](const char* name, int frame) {
    const Scene scene = make_scene(name);
    double most = 0;
    visit_positions(2000, 5, [&, here = at(scene, frame)](double x, double y) {
      most = std::max(most, glm::length(evaluate(here, x, y).backward));
    });
    return most;
  };
  EXPECT_EQ(longest("still", 9), 0);
  EXPECT_NEAR(longest("zoom", 9), 0.5 * std::hypot(kWidth, kHeight) * (1 - std::exp2(-1.0 / 40)), 0.1);
  EXPECT_GT(longest("teleport", 13), 150);
  EXPECT_LT(longest("teleport", 12), 1);
  EXPECT_NEAR(longest("quality-obj", 9), 12, 0.1);
}

TEST(SynthMotion, CutStartsAShotOfItsOwn) {
  const Scene scene = make_scene("cut");
  ASSERT_EQ(scene.shots.size(), 2u);
  EXPECT_NE(&shot_of(scene, 24), &shot_of(scene, 25));
  const Moment before = at(scene, 24), after = at(scene, 25);
  visit_positions(200, 3, [&](double x, double y) { EXPECT_NE(evaluate(before, x, y).id, evaluate(after, x, y).id); });
}

TEST(SynthMotion, WrongVectorsAreWrongWhereTheySayAndRightElsewhere) {
  for (const SceneRow& row : scene_table()) {
    const Scene scene = make_scene(row.name);
    Scene right = scene;
    for (Shot& shot : right.shots)
      for (Surface& surface : shot.surfaces) surface.vectors = Vectors::own;
    const bool jumps_only = row.name == "vectors-skinned";
    for (const int frame : {7, 12, 13, 24, 25, 40}) {
      int wrong = 0, marked = 0;
      const Moment said = at(scene, frame), true_one = at(right, frame);
      visit_positions(1500, std::uint64_t(frame), [&](double x, double y) {
        const Sample a = evaluate(said, x, y), b = evaluate(true_one, x, y);
        ASSERT_EQ(a.id, b.id);
        ASSERT_EQ(a.color, b.color);
        if (!a.surface) return;
        marked += a.surface->vectors != Vectors::own;
        const bool differs = glm::length(a.backward - b.backward) > 0.05;
        wrong += differs;
        if (a.surface->vectors == Vectors::own) {
          ASSERT_EQ(a.backward, b.backward) << row.name;
          ASSERT_EQ(a.forward, b.forward) << row.name;
        }
      });
      EXPECT_EQ(marked > 20, !scene.right_vectors) << row.name << " frame " << frame;
      if (jumps_only) {
        EXPECT_EQ(wrong, frame == 13 || frame == 25 ? marked : 0) << frame;
      } else if (!scene.right_vectors) {
        EXPECT_GT(wrong, marked / 3) << row.name << " frame " << frame;
      }
    }
  }
}

TEST(SynthMotion, OceanHasTheDepthOfTheGround) {
  const Scene scene = make_scene("vectors-ocean");
  const Sample sample = evaluate(at(scene, 5), 160.5, 160.5);
  EXPECT_EQ(sample.surface->name, "water");
  EXPECT_NEAR(sample.depth, 130 * 320 / 70.5, 1e-6);
}

TEST(SynthCamera, MatricesProjectWhatThePictureShows) {
  for (const char* name : {"pan", "zoom", "rotation", "quality-cam", "sky"}) {
    const Scene scene = make_scene(name);
    const Moment here = at(scene, 17), before = at(scene, 16);
    const Matrix camera = world_to_camera(here.camera), ndc = world_to_ndc(here.camera, kWidth, kHeight),
                 ndc_before = world_to_ndc(before.camera, kWidth, kHeight);
    const auto times = [](const glm::dvec4& row, const Matrix& m) {
      glm::dvec4 out{0};
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) out[c] += row[r] * m.values[4 * r + c];
      return out;
    };
    visit_positions(300, 1, [&](double x, double y) {
      const Sample p = evaluate(here, x, y);
      if (!p.surface || p.depth >= kFarDepth || p.surface->layer == Layer::middle) return;
      const glm::dvec3 seen = here.to_ray * glm::dvec3(x, y, 1) * p.depth;
      const glm::dvec4 world{here.camera.pose.rotation * seen + here.camera.pose.position, 1};
      const glm::dvec4 in_camera = times(world, camera), in_ndc = times(world, ndc), then = times(world, ndc_before);
      EXPECT_NEAR(in_camera.x, seen.x, 1e-8 * p.depth);
      EXPECT_NEAR(in_camera.y, -seen.y, 1e-8 * p.depth);
      EXPECT_NEAR(in_camera.z, p.depth, 1e-8 * p.depth);
      EXPECT_NEAR(in_ndc.x / in_ndc.w * kWidth, x, 1e-7);
      EXPECT_NEAR(in_ndc.y / in_ndc.w * kHeight, y, 1e-7);
      EXPECT_NEAR(then.x / then.w * kWidth, x + p.backward.x, 1e-6) << name;
      EXPECT_NEAR(then.y / then.w * kHeight, y + p.backward.y, 1e-6) << name;
    });
  }
}

TEST(SynthLayers, CompositeIsTheBeauty) {
  int layered = 0;
  for (const SceneRow& row : scene_table()) {
    const Scene scene = make_scene(row.name);
    bool several = false;
    for (const Surface& surface : scene.shots[0].surfaces) several = several || surface.layer != Layer::background;
    if (!several) continue;
    ++layered;
    for (const int frame : {1, 20, 24, 48}) {
      const Moment whole = at(scene, frame);
      const Moment parts[3] = {at(scene, frame, Layer::foreground), at(scene, frame, Layer::middle),
                               at(scene, frame, Layer::background)};
      visit_positions(2000, std::uint64_t(frame), [&](double x, double y) {
        glm::dvec4 sum{0};
        for (const Moment& part : parts) {
          const Sample s = evaluate(part, x, y);
          sum += glm::dvec4(s.color, s.alpha) * (1 - sum.a);
        }
        const Sample beauty = evaluate(whole, x, y);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(sum[c], beauty.color[c], 1e-12 + 1e-12 * sum[c]) << row.name;
        ASSERT_NEAR(sum.a, beauty.alpha, 1e-12);
      });
    }
  }
  EXPECT_GE(layered, 6);
}

TEST(SynthChance, StochasticSurfacesAreMetInAQuarterOfTheSamples) {
  const Scene scene = make_scene("stochastic-alpha");
  const Moment moment = at(scene, 9);
  for (const double x : {80.5, 210.5}) {
    const Sample expected = evaluate(moment, x, 90.5);
    int met = 0;
    const int n = 40000;
    glm::dvec3 sum{0};
    for (int i = 0; i < n; ++i) {
      const Sample s = evaluate(moment, x, 90.5, mix(99, std::uint64_t(i)));
      met += s.surface->stochastic;
      sum += s.color;
      ASSERT_EQ(s.alpha, 1);
    }
    EXPECT_NEAR(met / double(n), 0.25, 3 * std::sqrt(0.25 * 0.75 / n));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / n, expected.color[c], 0.02);
  }
}

TEST(SynthLight, EmittersReachTheEndOfHalf) {
  const Scene scene = make_scene("hdr");
  double most = 0, least = 1e30;
  visit_positions(60000, 4, [&, moment = at(scene, 24)](double x, double y) {
    const double r = evaluate(moment, x, y).color.r;
    most = std::max(most, r);
    least = std::min(least, r);
  });
  EXPECT_EQ(most, 65504);
  EXPECT_EQ(least, 0.02);
}

TEST(SynthLight, PulseIsLightWithoutMotion) {
  const Scene scene = make_scene("pulse");
  const Sample dark = evaluate(at(scene, 10), 266.7, 80.3), flash = evaluate(at(scene, 11), 266.7, 80.3);
  EXPECT_GT(flash.color.r, 8 * dark.color.r);
  EXPECT_EQ(flash.backward, glm::dvec2(0));
}

TEST(SynthScenes, UnknownNamesAreRefusedWithTheList) {
  try {
    make_scene("courtyard");
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::usage);
    EXPECT_NE(std::string(failure.what()).find("quality-all"), std::string::npos);
  }
}

TEST(SynthScenes, TheReadmeListsThem) {
  std::ifstream in(std::string(VARVE_SOURCE) + "/sequences/README.md", std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  std::string table;
  for (const SceneRow& row : scene_table())
    table += "| `" + std::string(row.name) + "` | " + std::string(row.provokes) + " |\n";
  EXPECT_NE(text.str().find("| --- | --- |\n" + table + "\n"), std::string::npos)
      << "the table of scenes in sequences/README.md should be\n"
      << table;
}

}  // namespace
}  // namespace varve::synth
