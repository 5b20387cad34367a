// varve probe --motion: what stored vectors mean, told by the pixels.
#include <gtest/gtest.h>

#include "scene_cli.h"

namespace varve::test {
namespace {

class ProbeMotion : public SceneCli {
 protected:
  Outcome probe(const std::string& scene, const Arguments& more = {}) const {
    Arguments line = {"probe", "in/" + scene + ".####.exr", "--motion"};
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }
};

bool has(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

TEST_F(ProbeMotion, RanksReadingsOfTheVectors) {
  synth("rotation", "20-23", {"--size", "160x90"});
  const Outcome text = probe("rotation");
  ASSERT_EQ(text.code, 0) << text.err;
  for (const char* word : {"Motion, measured from the pixels", "frames 20 and 21", "Verdict", "velocity.x, velocity.y",
                           "to the previous frame, pixels, x right, y down", "no motion"})
    EXPECT_TRUE(has(text.out, word)) << word << "\n" << text.out;
  const Outcome json = probe("rotation", {"--json"});
  ASSERT_EQ(json.code, 0) << json.err;
  for (const char* word : {"\"motion\":{\"pairs\":[{\"frame\":21,\"earlier\":20", "\"hypotheses\":[{", "\"finding\":"})
    EXPECT_TRUE(has(json.out, word)) << word << "\n" << json.out;
}

TEST_F(ProbeMotion, SteadyMotionLeavesTheDirectionToTheNames) {
  synth("pan", "20-23", {"--size", "160x90"});
  const Outcome outcome = probe("pan");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "velocity.x, velocity.y lead to the previous frame")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "varve, by their names")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "direction in time")) << outcome.out;
}

TEST_F(ProbeMotion, LayersToBothSidesTellTheDirection) {
  synth("rotation", "20-23", {"--size", "160x90"});
  const Outcome outcome = probe("rotation", {"--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "\"finding\":\"found\"")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "\"joined\":true")) << outcome.out;
}

TEST_F(ProbeMotion, OneFrameShowsNothing) {
  synth("pan", "20");
  const Outcome outcome = probe("pan");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "there is one frame only")) << outcome.out;
}

TEST_F(ProbeMotion, WithoutTheOptionHeadersAreAllThatIsRead) {
  synth("pan", "20-21");
  const Outcome outcome = run_varve({"probe", "in/pan.####.exr"}, folder.path());
  EXPECT_FALSE(has(outcome.out, "measured from the pixels")) << outcome.out;
}

}  // namespace
}  // namespace varve::test
