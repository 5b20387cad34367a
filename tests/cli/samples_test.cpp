// varve resolve --samples as a user meets it: numbered parts, grids, what is written, and what is refused.
#include <gtest/gtest.h>

#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

class SamplesCli : public SceneCli {
 protected:
  static constexpr const char* kScene = "in/crossing.####.exr";

  void make(const std::string& frames, const Arguments& more = {}) const {
    Arguments all = {"--samples", "3", "--truth", "box", "--truth-samples", "36"};
    all.insert(all.end(), more.begin(), more.end());
    synth("crossing", frames, all);
  }
  Outcome resolve(const std::string& to, const Arguments& choices, const Arguments& more = {}) const {
    return resolve_into(kScene, to, choices, more);
  }
  /// Of frames 3 and on.
  double quality(const std::string& to) const { return psnr("crossing", to, "3-5"); }
};

TEST_F(SamplesCli, BothWaysAreBetterThanOneSampleWithEveryAccumulator) {
  make("1-5");
  for (const std::string accumulator : {"recursive", "two-sided", "gather"}) {
    const Arguments by = {"--accumulator", accumulator};
    const auto with = [&](Arguments more) {
      more.insert(more.end(), by.begin(), by.end());
      return more;
    };
    ASSERT_EQ(resolve("one", with({"--layer", "sample.0"})).code, 0);
    const Outcome first = resolve("first", with({"--samples", "resolve"}));
    ASSERT_EQ(first.code, 0) << first.err;
    const Outcome each = resolve("each", with({"--samples", "each"}));
    ASSERT_EQ(each.code, 0) << each.err;
    fs::create_directories(folder / "bare");
    for (int frame = 3; frame <= 5; ++frame) {
      // sample.0 among its like is no main color: compare finds it by name.
      EXPECT_FALSE(bytes_of(path("each", frame)).empty());
      EXPECT_NE(bytes_of(path("each", frame)), bytes_of(path("first", frame)));
    }
    const std::string out = run_varve({"compare", "in/truth/crossing.####.exr", "one/o.####.exr", "-f", "3-5",
                                       "--metrics", "psnr", "--json", "-"},
                                      folder.path())
                                .out;
    const std::size_t at = out.find("\"psnr\":");
    ASSERT_NE(at, std::string::npos) << out;
    const double one = std::strtod(out.c_str() + at + 7, nullptr);
    EXPECT_GT(quality("first"), one + 1) << accumulator;
    EXPECT_GT(quality("each"), one + 1) << accumulator;
    for (const char* const folder_of : {"one", "first", "each"}) fs::remove_all(folder / folder_of);
  }
}

TEST_F(SamplesCli, WritesOneFlatPartWithBareNames) {
  make("1-2");
  ASSERT_EQ(resolve("out", {"--samples", "resolve"}).code, 0);
  const std::string text = run_varve({"probe", "out/o.0002.exr"}, folder.path()).out;
  EXPECT_NE(text.find("part 0: "), std::string::npos) << text;
  EXPECT_EQ(text.find("part 1"), std::string::npos) << text;
  EXPECT_EQ(text.find("sample."), std::string::npos) << text;
  for (const char* const channel : {"    R ", "    A ", "    Z ", "    id ", "    velocity.x "})
    EXPECT_NE(text.find(channel), std::string::npos) << channel << text;
  // What is kept is that of one sample: the nearest to the middle. Its place there is not that of the result.
  EXPECT_NE(text.find("none found"), std::string::npos) << text;
  ASSERT_EQ(resolve("bare", {"--samples", "resolve", "--keep", "none"}).code, 0);
  EXPECT_EQ(run_varve({"probe", "bare/o.0002.exr"}, folder.path()).out.find("    Z "), std::string::npos);
}

TEST_F(SamplesCli, AnyPartOfTheSequenceAndAnyThreadsGiveTheSameBytes) {
  make("1-5");
  for (const std::string mode : {"resolve", "each"}) {
    const Arguments line = {"--samples", mode, "--accumulator", "gather", "--reach", "2", "--aov", "all"};
    ASSERT_EQ(resolve("whole", line, {"--threads", "1"}).code, 0);
    ASSERT_EQ(resolve("part", line, {"-f", "3", "--threads", "3"}).code, 0);
    EXPECT_TRUE(bytes_of(path("whole", 3)) == bytes_of(path("part", 3))) << mode;
  }
  ASSERT_EQ(resolve("one", {"--samples", "each"}, {"--threads", "1", "--aov", "all"}).code, 0);
  ASSERT_EQ(resolve("three", {"--samples", "each"}, {"--threads", "3", "--aov", "all"}).code, 0);
  EXPECT_TRUE(bytes_of(path("one", 5)) == bytes_of(path("three", 5)));
}

TEST_F(SamplesCli, PositionsAreUsedWhereTheyAreKnown) {
  make("1-5");
  const Arguments filter = {"--samples", "resolve", "--sample-filter", "gaussian"};
  ASSERT_EQ(resolve("known", filter).code, 0);
  const Outcome unknown = resolve("unknown", filter, {"--jitter", "none"});
  EXPECT_EQ(unknown.code, 4);
  EXPECT_NE(unknown.err.find("--jitter"), std::string::npos) << unknown.err;
  // The sidecar says what the headers say, and so does the pattern that it was made by.
  for (const std::string jitter : {"in/jitter.csv", "halton23:16"}) {
    ASSERT_EQ(resolve("said", filter, {"--jitter", jitter}).code, 0);
    EXPECT_EQ(pixel_of(path("said", 5), "R", 20, 11), pixel_of(path("known", 5), "R", 20, 11)) << jitter;
  }
}

TEST_F(SamplesCli, AGridIsResolvedToItsPixels) {
  synth("crossing", "1-5", {"--truth", "box", "--truth-samples", "36"});
  ASSERT_EQ(run_varve({"synth", "crossing", "-o", "grid", "--size", "128x72", "-f", "1-5", "-q"}, folder.path()).code,
            0);
  for (const std::string how : {"grid:2", "each,grid:2"})
    for (const std::string accumulator : {"recursive", "gather"}) {
      const Outcome done =
          resolve_into("grid/crossing.####.exr", "out", {"--samples", how, "--accumulator", accumulator}, {});
      ASSERT_EQ(done.code, 0) << done.err;
      EXPECT_GT(quality("out"), 20) << how << accumulator;
      EXPECT_EQ(pixel_of(path("out", 4), "id", 63, 35) > 0, true);
    }
  const std::string text = run_varve({"probe", "out/o.0004.exr"}, folder.path()).out;
  EXPECT_NE(text.find("data 64x36 at 0,0, display 64x36 at 0,0"), std::string::npos) << text;
  // Vectors that are passed on count the pixels of the result.
  ASSERT_EQ(run_varve({"resolve", "in/crossing.####.exr", "-o", "plain.####.exr", "-f", "4"}, folder.path()).code, 0);
  EXPECT_NEAR(pixel_of(path("out", 4), "velocity.x", 2, 2), pixel_of(folder / "plain.0004.exr", "velocity.x", 2, 2),
              0.05);
}

TEST_F(SamplesCli, ProbeSaysWhatIsFound) {
  make("1-2");
  const Outcome probe = run_varve({"probe", kScene, "--samples", "resolve"}, folder.path());
  ASSERT_EQ(probe.code, 0) << probe.err;
  EXPECT_NE(probe.out.find("samples: 3 found"), std::string::npos) << probe.out;
  EXPECT_NE(probe.out.find("positions are known"), std::string::npos) << probe.out;
  EXPECT_NE(probe.out.find("longest"), std::string::npos) << probe.out;
  EXPECT_NE(run_varve({"probe", kScene, "--samples", "each", "--jitter", "none"}, folder.path()).out.find("not known"),
            std::string::npos);
}

TEST_F(SamplesCli, WhatCannotBeDoneIsRefusedWithARemedy) {
  make("1-2");
  synth("pan", "1-2", {"-o", "plain"});
  const auto refusal = [&](const std::string& input, const Arguments& line, int code) {
    Arguments all = {"resolve", input, "-o", "no.####.exr"};
    all.insert(all.end(), line.begin(), line.end());
    const Outcome outcome = run_varve(all, folder.path());
    EXPECT_EQ(outcome.code, code) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(refusal("plain/pan.####.exr", {"--samples", "resolve"}, 4).find("grid:N"), std::string::npos);
  EXPECT_NE(refusal("plain/pan.####.exr", {"--samples", "grid:5"}, 4).find("multiples of 5"), std::string::npos);
  EXPECT_NE(refusal(kScene, {"--samples", "grid:1"}, 2).find("grid:2"), std::string::npos);
  EXPECT_NE(refusal(kScene, {"--samples", "some"}, 2).find("resolve"), std::string::npos);
  // A frame with a sample less.
  fs::create_directories(folder / "less");
  ASSERT_EQ(run_varve({"synth", "crossing", "-o", "less", "--size", "64x36", "-f", "2", "--samples", "2", "-q"},
                      folder.path())
                .code,
            0);
  fs::copy_file(folder / "in/crossing.0001.exr", folder / "less/crossing.0001.exr");
  EXPECT_NE(refusal("less/crossing.####.exr", {"--samples", "each"}, 4).find("frame 2"), std::string::npos);
}

}  // namespace
}  // namespace varve::test
