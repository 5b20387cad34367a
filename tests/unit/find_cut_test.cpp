// Cuts are found in scenes that have them, and only there.
#include "stages/find_cut.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <map>

#include "resolve_sequence.h"
#include "support/scenes.h"
#include "synth_sequence.h"

namespace varve {
namespace {

namespace fs = std::filesystem;

struct Seen {
  std::vector<int> cuts;
  std::vector<std::string> warnings;
};

/// Cuts found in frames of a scene.
Seen cuts_in(const std::string& scene, const std::string& frames, double noise, bool vectors = true) {
  const fs::path folder = fs::path(testing::TempDir()) / ("find_cut_" + scene + std::to_string(getpid()));
  fs::remove_all(folder);
  SynthJob synth;
  synth.scene = scene;
  synth.folder = folder.string();
  synth.frames = parse_frame_list(frames);
  synth.noise = noise;
  synth_sequence(synth, {});
  ResolveJob job;
  job.input.color = SequencePattern::parse((folder / (scene + ".####.exr")).string());
  job.output = SequencePattern::parse((folder / "out.####.exr").string());
  job.find_cuts = true;
  job.request.keep_channels = false;
  if (!vectors) job.roles.convention = "none";
  Seen seen;
  ResolveEvents events;
  events.warning = [&](const std::string& sentence) { seen.warnings.push_back(sentence); };
  events.frame = [&](const FrameReport& report, int, int) {
    if (!report.restart.starts_with("cut")) return;
    seen.cuts.push_back(report.frame);
    EXPECT_EQ(report.rejected[1], report.pixels);  // decided before the frame met its history
  };
  resolve_sequence(job, events);
  fs::remove_all(folder);
  return seen;
}

TEST(FindCut, FindsTheCutAndTellsTheEvidence) {
  for (const double noise : {0.0, 0.5}) {
    const Seen seen = cuts_in("cut", "23-27", noise);
    EXPECT_EQ(seen.cuts, std::vector<int>{25}) << noise;
    ASSERT_EQ(seen.warnings.size(), 1u);
    EXPECT_NE(seen.warnings[0].find("frame 25"), std::string::npos);
    EXPECT_NE(seen.warnings[0].find(" % of the picture"), std::string::npos) << seen.warnings[0];
  }
  EXPECT_EQ(cuts_in("cut", "23-27", 0, false).cuts, std::vector<int>{25});
}

TEST(FindCut, MovesLightAndLeapsAreNoCuts) {
  for (const auto& [scene, frames] : std::map<std::string, std::string>{{"pulse", "8-14"},
                                                                        {"pan", "1-4"},
                                                                        {"teleport", "12-14"},
                                                                        {"quality-cam", "1-4"},
                                                                        {"sky", "1-4"},
                                                                        {"shadow", "1-4"}})
    for (const double noise : {0.0, 0.5}) {
      const Seen seen = cuts_in(scene, frames, noise);
      EXPECT_TRUE(seen.cuts.empty()) << scene << " noise " << noise << ": "
                                     << (seen.warnings.empty() ? "" : seen.warnings[0]);
    }
}

TEST(FindCut, WithoutVectorsAMoveIsNoCutEither) {
  for (const char* scene : {"pan", "quality-cam"}) {
    const Seen seen = cuts_in(scene, "1-4", 0, false);
    EXPECT_TRUE(seen.cuts.empty()) << scene << ": " << (seen.warnings.empty() ? "" : seen.warnings[0]);
  }
}

Present picture(const Window& w, unsigned seed, float light, Workers& workers) {
  Present p = test::noise_present(w, {seed, 0, 0, 0, false, 1}, workers);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      // Smooth blobs that differ with the seed, so that neighboring blocks hang together.
      const float v = 1.5f + std::sin(float(x) * 0.11f * float(seed % 5 + 1) + float(seed)) *
                                 std::cos(float(y) * 0.07f * float(seed % 3 + 1) - float(seed));
      p.color.at(x, y) = glm::vec4(v * light, v * 0.8f * light, v * 0.5f * light, 1);
    }
  return p;
}

TEST(FindCut, ExposureAloneIsNoEvidence) {
  Workers workers(1);
  const Window w{0, 0, 200, 120};
  const Present dark = picture(w, 4, 1, workers);
  for (const float light : {1e-6f, 0.25f, 8.0f, 1e6f}) {
    const Present lit = picture(w, 4, light, workers);
    const CutEvidence e =
        judge_cut(trace_of(dark, dark.motion, {}, 1, workers), trace_of(lit, lit.motion, {}, 2, workers));
    EXPECT_FALSE(e.cut);
    EXPECT_LT(e.unexplained, 1e-9);
    EXPECT_LT(e.distance, 1e-3);
  }
  const Present other = picture(w, 5, 1, workers);
  const CutEvidence e =
      judge_cut(trace_of(dark, dark.motion, {}, 1, workers), trace_of(other, other.motion, {}, 2, workers));
  EXPECT_TRUE(e.cut) << e.judged << " " << e.sentence;
}

TEST(FindCut, CamerasAreComparedByTheirTurn) {
  Workers workers(1);
  const Window w{0, 0, 120, 80};
  const Present p = picture(w, 4, 1, workers);
  const auto camera = [](double degrees, double scale) -> std::optional<std::vector<double>> {
    const double c = std::cos(degrees * 3.14159265358979 / 180), s = std::sin(degrees * 3.14159265358979 / 180);
    std::vector<double> matrix = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 5, 6, 7, 1};
    for (double& n : matrix) n *= scale;
    return matrix;
  };
  for (const double turn : {0.0, 3.0, 40.0, 170.0}) {
    const CutEvidence e = judge_cut(trace_of(p, p.motion, camera(10, 1), 1, workers),
                                    trace_of(p, p.motion, camera(10 + turn, 100), 2, workers));
    EXPECT_NEAR(e.turned, turn, 1e-4);
    EXPECT_FALSE(e.cut);  // the picture is the same: a matrix alone decides nothing
    EXPECT_EQ(e.sentence.find("turned") != std::string::npos, turn > 1) << e.sentence;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(
      judge_cut(trace_of(p, p.motion, camera(10, 0), 1, workers), trace_of(p, p.motion, camera(nan, 1), 2, workers))
          .turned,
      0);
}

TEST(FindCut, HostilePicturesAreJudgedWithoutHarm) {
  Workers workers(1);
  const Window w{0, 0, 50, 46};
  std::vector<Present> all;
  for (const float value : {0.0f, -5.0f, 3e38f, 1e-45f})
    all.push_back(test::flat_present(w, glm::vec4(value), workers));
  all.push_back(test::flat_present(w, glm::vec4(std::numeric_limits<float>::quiet_NaN()), workers));
  all.push_back(test::flat_present({4, 4, 5, 5}, glm::vec4(1.0f), workers));
  all.push_back(test::noise_present({-9, 0, 300, 7}, {1, 0.5, 1e9, 0.5, false, 1e30f}, workers));
  for (const Present& a : all)
    for (const Present& b : all) {
      const CutEvidence e = judge_cut(trace_of(a, a.motion, {}, 1, workers), trace_of(b, b.motion, {}, 2, workers));
      EXPECT_TRUE(std::isfinite(e.distance) && std::isfinite(e.unexplained) && std::isfinite(e.judged));
    }
  EXPECT_FALSE(judge_cut({}, trace_of(all[0], all[0].motion, {}, 1, workers)).cut);
}

}  // namespace
}  // namespace varve
