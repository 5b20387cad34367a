// varve resolve --accumulator subpixel as a user meets it: gain, chunks, threads, planes, and what is refused.
#include <gtest/gtest.h>

#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

class SubpixelCli : public SceneCli {
 protected:
  Outcome resolve(const std::string& to, const Arguments& more = {}) const {
    return resolve_into("in/pan.####.exr", to, {"--preset", "yang", "--check-motion", "off"}, more);
  }
};

TEST_F(SubpixelCli, GainsOverPlainReprojection) {
  synth("pan", "1-20", {"--size", "80x45", "--jitter", "quadrants:32", "--truth", "box", "--truth-samples", "36"});
  ASSERT_EQ(resolve("four").code, 0);
  ASSERT_EQ(resolve("one", {"--accumulator", "recursive", "--history-filter", "bilinear", "--alpha", "0.1",
                            "--blur-limit", "0", "--residual-limit", "0"})
                .code,
            0);
  EXPECT_GT(psnr("pan", "four", "9-20"), psnr("pan", "one", "9-20") + 2);
}

TEST_F(SubpixelCli, ChunksAndThreadsGiveTheSameBytes) {
  synth("pan", "1-8");
  ASSERT_EQ(resolve("whole", {"--threads", "1"}).code, 0);
  ASSERT_EQ(resolve("part", {"-f", "5-8", "--preroll", "4", "--threads", "3"}).code, 0);
  ASSERT_EQ(resolve("again", {"--threads", "3"}).code, 0);
  for (int frame = 1; frame <= 8; ++frame)
    EXPECT_TRUE(bytes_of(path("whole", frame)) == bytes_of(path("again", frame))) << frame;
}

TEST_F(SubpixelCli, WritesEveryPlaneAndSaysWhatItDoes) {
  synth("pan", "1-5");
  ASSERT_EQ(resolve("all", {"--aov", "all"}).code, 0);
  ASSERT_EQ(resolve("table", {"--blur-bound", "table", "--subpixel-weights", "bilinear"}).code, 0);
  ASSERT_EQ(resolve("single", {"--accumulator", "recursive", "--aov", "blur-variance,residual"}).code, 0);
  const Outcome plan = resolve("dry", {"--dry-run"});
  EXPECT_EQ(plan.code, 0);
  EXPECT_TRUE((plan.out + plan.err).find("sub-pixel histories") != std::string::npos);
}

TEST_F(SubpixelCli, WithoutJitterItSaysWhatToDo) {
  synth("pan", "1-3");
  const Outcome refused = resolve("none", {"--jitter", "none"});
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(refused.err.find("--assume-jitter") != std::string::npos) << refused.err;
}

TEST_F(SubpixelCli, SaysWhichQuartersAreNeverVisited) {
  synth("pan", "1-6", {"--jitter", "two-frame"});
  const Outcome plan = resolve("dry", {"--dry-run"});
  EXPECT_TRUE((plan.out + plan.err).find("never visits") != std::string::npos) << plan.out << plan.err;
  EXPECT_EQ(resolve("done").code, 0);
}

TEST_F(SubpixelCli, RefusesWhatItCannotDo) {
  synth("pan", "1-2");
  EXPECT_EQ(resolve("a", {"--sample-filter", "tent"}).code, 2);
  EXPECT_EQ(resolve("b", {"--acceleration", "1"}).code, 2);
  EXPECT_EQ(resolve("c", {"--feedback", "luma"}).code, 2);
  EXPECT_EQ(resolve("d", {"--accumulator", "two-sided"}).code, 2);  // its bounds
}

TEST_F(SubpixelCli, TakesAllSamplesOfAPixel) {
  synth("pan", "1-4", {"--samples", "4"});
  EXPECT_EQ(resolve("each", {"--samples", "each", "--aov", "all"}).code, 0);
  EXPECT_EQ(resolve("mean", {"--samples", "resolve"}).code, 0);
}

}  // namespace
}  // namespace varve::test
