// Cameras from the command line: scenes whose vectors lack what the camera did, resolved with and without.
#include <cmath>
#include <fstream>
#include <sstream>

#include "scene_cli.h"

namespace varve::test {
namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

class CameraCli : public SceneCli {
 protected:
  std::string input(const std::string& scene) const { return "in/" + scene + ".####.exr"; }
  Outcome resolve(const std::string& scene, const std::string& to, const Arguments& choices,
                  const Arguments& more = {}) const {
    return resolve_into(input(scene), to, choices, more);
  }
};

const Arguments kGather = {"--preset", "draft"}, kSalvi = {"--preset", "salvi"}, kBoth = {"--preset", "two-sided"};

TEST_F(CameraCli, ATexturedSkyFollowsTheCamera) {
  synth("sky-zero", "20-28", {"--truth", "box", "--truth-samples", "64"});
  for (const Arguments& preset : {kGather, kSalvi, kBoth}) {
    const std::string name = preset[1];
    ASSERT_EQ(resolve("sky-zero", name + "-off", preset, {"--camera", "off"}).code, 0);
    const Outcome with = resolve("sky-zero", name + "-on", preset, {"--camera-motion", "background"});
    ASSERT_EQ(with.code, 0) << with.err;
    EXPECT_TRUE(says(with.err, "% of the vectors by the camera")) << with.err;
    EXPECT_GT(psnr("sky-zero", name + "-on", "23-25"), psnr("sky-zero", name + "-off", "23-25") + 0.5) << name;
  }
}

TEST_F(CameraCli, ZoomAndShiftThatTheVectorsLackAreAdded) {
  for (const std::string scene : {"zoom-lacking", "shift-lacking"}) {
    synth(scene, "20-26", {"--truth", "box", "--truth-samples", "64"});
    for (const Arguments& preset : {kGather, kSalvi}) {
      const std::string name = scene + preset[1];
      ASSERT_EQ(resolve(scene, name + "-off", preset, {"--camera", "off"}).code, 0);
      const Outcome with = resolve(scene, name + "-on", preset, {"--camera-motion", "zoom"});
      ASSERT_EQ(with.code, 0) << with.err;
      EXPECT_TRUE(says(with.err, "% of the vectors with zoom added")) << with.err;
      EXPECT_GT(psnr(scene, name + "-on", "22-24"), psnr(scene, name + "-off", "22-24") + 0.3) << name;
    }
  }
}

TEST_F(CameraCli, VectorsThatKnowTheZoomStay) {
  synth("zoom", "22-25");
  ASSERT_EQ(resolve("zoom", "off", kSalvi, {"--camera", "off"}).code, 0);
  const Outcome with = resolve("zoom", "on", kSalvi, {"--camera-motion", "zoom"});
  ASSERT_EQ(with.code, 0);
  EXPECT_FALSE(says(with.err, "zoom added"));
  const std::string same = run_varve({"compare", "off/o.####.exr", "on/o.####.exr"}, folder.path()).out;
  EXPECT_EQ(run_varve({"compare", "off/o.####.exr", "on/o.####.exr"}, folder.path()).code, 0) << same;
}

TEST_F(CameraCli, MissingVectorsAreMadeFromDepth) {
  synth("pan", "20-26", {"--truth", "box", "--truth-samples", "64"});
  const Arguments none = {"--convention", "none"};
  const auto with = [&](const Arguments& preset, const Arguments& more) {
    Arguments all = preset;
    all.insert(all.end(), none.begin(), none.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  for (const Arguments& preset : {kGather, kSalvi}) {
    ASSERT_EQ(resolve("pan", preset[1] + "file", preset).code, 0);
    ASSERT_EQ(resolve("pan", preset[1] + "none", with(preset, {"--camera", "off"})).code, 0);
    const Outcome made = resolve("pan", preset[1] + "made", with(preset, {}));
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(says(made.err, "100.0 % of the vectors by the camera")) << made.err;
    const double file = psnr("pan", preset[1] + "file", "22-24");
    EXPECT_NEAR(psnr("pan", preset[1] + "made", "22-24"), file, 0.1);
    EXPECT_LT(psnr("pan", preset[1] + "none", "22-24"), file - 0.3);
  }
}

TEST_F(CameraCli, EverySourceGivesTheSamePicture) {
  synth("sky-zero", "22-25");
  ASSERT_EQ(resolve("sky-zero", "attributes", kSalvi, {"--camera-motion", "all"}).code, 0);
  synth("sky-zero", "22-25", {"--cameras", "note"});
  ASSERT_EQ(resolve("sky-zero", "note", kSalvi, {"--camera-motion", "all"}).code, 0);
  const Outcome probe = run_varve({"probe", input("sky-zero"), "--camera-motion", "all"}, folder.path());
  EXPECT_TRUE(says(probe.out, "view and proj in the attribute Note in 4 of 4 frames")) << probe.out;
  EXPECT_TRUE(says(probe.out, "which turns")) << probe.out;
  synth("sky-zero", "22-25", {"--cameras", "none"});
  // A turn of 0.8 degrees a frame about the upright axis, as the scene has it; 35.56 mm on 35.56 mm of film.
  std::string csv = "frame";
  for (int i = 0; i < 16; ++i) csv += ",v" + std::to_string(i);
  csv += ",focal,aperture\n";
  for (int frame = 22; frame <= 25; ++frame) {
    const double a = 0.8 * 0.017453292519943295 * (frame - 24), c = std::cos(a), s = std::sin(a);
    std::ostringstream row;
    row.precision(17);
    // World y and z of the scene point down and away; the camera's up and back.
    row << frame << "," << c << ",0," << -s << ",0,0,-1,0,0," << -s << ",0," << -c << ",0,0,0,0,1,35.56,35.56\n";
    csv += row.str();
  }
  std::ofstream(folder / "cameras.csv") << csv;
  ASSERT_EQ(resolve("sky-zero", "table", kSalvi, {"--camera-motion", "all", "--camera", "cameras.csv"}).code, 0);
  ASSERT_EQ(resolve("sky-zero", "nothing", kSalvi, {"--camera-motion", "all"}).code, 0);
  const auto equal = [&](const std::string& a, const std::string& b) {
    return run_varve({"compare", a + "/o.####.exr", b + "/o.####.exr", "--fail", "max=0.01"}, folder.path());
  };
  EXPECT_EQ(equal("attributes", "note").code, 0) << equal("attributes", "note").out;
  EXPECT_EQ(equal("attributes", "table").code, 0) << equal("attributes", "table").out;
  EXPECT_EQ(equal("attributes", "nothing").code, 1);
}

TEST_F(CameraCli, AChunkIsThatPartOfTheWhole) {
  synth("sky-zero", "18-29");
  for (const Arguments& preset : {kGather, kBoth}) {
    ASSERT_EQ(resolve("sky-zero", preset[1] + "whole", preset, {"--camera-motion", "all", "-j", "1"}).code, 0);
    ASSERT_EQ(
        resolve("sky-zero", preset[1] + "part", preset, {"--camera-motion", "all", "-j", "3", "-f", "23-24"}).code, 0);
    for (const int frame : {23, 24})
      EXPECT_EQ(bytes_of(path(preset[1] + "whole", frame)), bytes_of(path(preset[1] + "part", frame)));
  }
}

TEST_F(CameraCli, BadSourcesAreRefused) {
  synth("pan", "1-2");
  EXPECT_EQ(resolve("pan", "a", kSalvi, {"--camera", "nowhere"}).code, 2);
  EXPECT_EQ(resolve("pan", "b", kSalvi, {"--camera", "no/such.json"}).code, 3);
  std::ofstream(folder / "flat.json")
      << R"([{"frame":1,"view":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1],"focal":1,"aperture":1}])";
  const Outcome flat = resolve("pan", "c", kSalvi, {"--camera", "flat.json"});
  EXPECT_EQ(flat.code, 4);
  EXPECT_TRUE(says(flat.err, "frame 1")) << flat.err;
  EXPECT_EQ(resolve("pan", "d", kSalvi, {"--camera-motion", "sometimes"}).code, 2);
}

}  // namespace
}  // namespace varve::test
