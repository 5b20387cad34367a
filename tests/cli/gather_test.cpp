// varve resolve --accumulator gather as a user meets it: quality, chunks, what the files lack, gaps and cuts.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

class GatherCli : public SceneCli {
 protected:
  /// Resolves INPUT into `to`.
  Outcome resolve(const std::string& input, const std::string& to, const Arguments& more = {}) const {
    return resolve_into(input, to, {"--accumulator", "gather"}, more);
  }

  void expect_same_files(const std::string& part, const std::string& whole) const {
    const std::vector<std::string> names = files_below(folder / part);
    ASSERT_FALSE(names.empty());
    for (const std::string& name : names)
      EXPECT_TRUE(bytes_of(folder / (part + "/" + name)) == bytes_of(folder / (whole + "/" + name))) << part << name;
  }
};

TEST_F(GatherCli, IsFarBetterThanTheRecursiveOne) {
  synth("crossing", "1-14", {"--size", "96x54", "--truth", "box", "--truth-samples", "36"});
  ASSERT_EQ(resolve("in/crossing.####.exr", "gathered").code, 0);
  fs::create_directory(folder / "salvi");
  ASSERT_EQ(
      run_varve({"resolve", "in/crossing.####.exr", "-o", "salvi/o.####.exr", "--preset", "salvi"}, folder.path()).code,
      0);
  const double recursive = psnr("crossing", "salvi", "4-14"), gathered = psnr("crossing", "gathered", "4-14");
  EXPECT_GT(recursive, 15);
  EXPECT_GT(gathered, recursive + 4);
  // Backward vectors alone do nearly as well.
  const Outcome inverted = resolve("in/crossing.####.exr", "inverted", backward_only);
  ASSERT_EQ(inverted.code, 0) << inverted.err;
  EXPECT_GT(psnr("crossing", "inverted", "4-14"), gathered - 0.7);
}

TEST_F(GatherCli, AnyPartOfTheSequenceResolvesToTheSameBytes) {
  synth("crossing", "1-10");
  for (const Arguments& vectors : {Arguments{}, backward_only})
    for (const char* const reach : {"2", "16"}) {
      Arguments line = {"--aov", "all", "--reach", reach, "--cuts", "8"};
      line.insert(line.end(), vectors.begin(), vectors.end());
      const auto with = [&](Arguments more) {
        more.insert(more.end(), line.begin(), line.end());
        return more;
      };
      fs::remove_all(folder / "whole");
      const Outcome whole = resolve("in/crossing.####.exr", "whole", with({"--threads", "1"}));
      ASSERT_EQ(whole.code, 0) << whole.err;
      for (const std::string part : {"1-5", "6-10", "7", "2-10x4"})
        for (const char* const threads : {"2", "3"}) {
          fs::remove_all(folder / "part");
          ASSERT_EQ(resolve("in/crossing.####.exr", "part", with({"-f", part, "--threads", threads})).code, 0);
          expect_same_files("part", "whole");
        }
    }
}

TEST_F(GatherCli, ChunksAreExactAcrossCutsGapsAndMissingFrames) {
  synth("crossing", "1-12", {"--size", "48x27"});
  for (const int missing : {5, 9}) fs::remove(folder / ("in/crossing." + number(missing) + ".exr"));
  for (const char* preset : {"draft", "two-sided"}) {
    const Arguments choices = {"-p", preset, "--aov", "all", "--cuts", "3,7"};
    for (const char* old : {"whole", "part"}) fs::remove_all(folder / old);
    ASSERT_EQ(resolve_into("in/crossing.####.exr", "whole", choices, {}).code, 0);
    for (const char* part : {"1-2", "3-6x3", "4", "7-8", "10-12"})
      ASSERT_EQ(resolve_into("in/crossing.####.exr", "part", choices, {"-f", part}).code, 0);
    EXPECT_EQ(files_below(folder / "part").size(), 10u);
    expect_same_files("part", "whole");
  }
}

TEST_F(GatherCli, AllPlanesAreFinite) {
  synth("crossing", "1-6");
  ASSERT_EQ(resolve("in/crossing.####.exr", "o", {"--aov", "all", "--reach", "3"}).code, 0);
  for (const int frame : {1, 3, 6}) {
    for (const std::string plane :
         {"weight", "reject", "count-past", "count-future", "variance", "frames", "surfaces", "gain", "round-trip"})
      for (int y = 0; y < 36; y += 3)
        for (int x = 0; x < 64; x += 4) {
          const float value = pixel_of(path("o", frame), "varve." + plane, x, y);
          ASSERT_TRUE(std::isfinite(value) && value >= 0) << plane << " " << x << "," << y << " " << value;
        }
    const float frames = pixel_of(path("o", frame), "varve.frames", 30, 18);
    EXPECT_GE(frames, frame == 3 ? 5 : 3);
    EXPECT_LE(frames, frame == 3 ? 6 : 4);
    EXPECT_EQ(pixel_of(path("o", frame), "varve.count-past", 30, 18) > 0, frame > 1);
    EXPECT_EQ(pixel_of(path("o", frame), "varve.count-future", 30, 18) > 0, frame < 6);
  }
}

TEST_F(GatherCli, ThePlanSaysWhatTheFilesLack) {
  synth("crossing", "1-3");
  const auto plan = [&](const std::string& input, Arguments more) {
    more.push_back("--dry-run");
    const Outcome outcome = resolve(input, "o", more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    // As one line of single blanks, wherever the text was broken.
    std::string text;
    for (const char c : outcome.out + outcome.err)
      if (c != '\n' && !(c == ' ' && text.ends_with(' ')))
        text += c;
      else if (c == '\n' && !text.ends_with(' '))
        text += ' ';
    return text;
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  const std::string both = plan("in/crossing.####.exr", {});
  EXPECT_TRUE(has(both, "the files have vectors in both directions")) << both;
  EXPECT_FALSE(has(both, "JITTER")) << both;
  EXPECT_FALSE(has(both, "no object ids")) << both;
  const std::string one = plan("in/crossing.####.exr", backward_only);
  EXPECT_TRUE(has(one, "vectors of one direction are missing")) << one;

  EXPECT_TRUE(has(plan("in/crossing.####.exr", {"--jitter", "none"}), "THE JITTER IS NOT KNOWN"));

  // Files as Cycles writes them, with one thing less.
  const auto lacking = [&](const SmallSequence& sequence, const Arguments& more = {}) {
    write_small_sequence(folder.path(), sequence);
    return plan("in.####.exr", more);
  };
  const std::string all = lacking({.frames = 3});
  EXPECT_FALSE(has(all, "there is no depth") || has(all, "no object ids") || has(all, "JITTER IS")) << all;
  EXPECT_TRUE(has(all, "told apart by id and depth")) << all;
  const std::string flat = lacking({.frames = 3, .with_depth = false});
  EXPECT_TRUE(has(flat, "there is no depth, so the gather cannot tell what is in front")) << flat;
  EXPECT_TRUE(has(flat, "followed by their ids")) << flat;
  const std::string nameless = lacking({.frames = 3, .with_ids = false});
  EXPECT_TRUE(has(nameless, "there are no object ids")) << nameless;
  const std::string bare =
      lacking({.frames = 3, .with_vectors = false, .with_depth = false, .with_ids = false}, {"--convention", "none"});
  EXPECT_TRUE(has(bare, "no vectors, so every sample stays where it is")) << bare;
  EXPECT_TRUE(has(bare, "are not told apart")) << bare;
  // And all of them resolve.
  for (const Arguments& more :
       {Arguments{"--convention", "none"}, Arguments{"--convention", "none", "--jitter", "none"}})
    EXPECT_EQ(resolve("in.####.exr", "bare", more).code, 0);
  EXPECT_NEAR(pixel_of(path("bare", 2), "ViewLayer.Combined.R", 3, 3), 0.25, 1e-3);
}

TEST_F(GatherCli, NothingCrossesAGapOrACut) {
  synth("cut", "19-30");
  const Arguments counts = {"--aov", "count-past,count-future,frames", "--cuts", "25"};
  const Outcome whole = resolve("in/cut.####.exr", "cut", counts);
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_NE(whole.err.find("frame 25"), std::string::npos);
  EXPECT_NE(whole.err.find("cut"), std::string::npos) << whole.err;
  const auto at = [&](const std::string& to, int frame, const char* plane) {
    return pixel_of(path(to, frame), plane, 30, 18);
  };
  EXPECT_EQ(at("cut", 25, "varve.count-past"), 0);
  EXPECT_GT(at("cut", 25, "varve.count-future"), 0);
  EXPECT_EQ(at("cut", 24, "varve.count-future"), 0);
  EXPECT_GT(at("cut", 24, "varve.count-past"), 0);
  // Each shot by itself is the same.
  Arguments second = counts;
  second.insert(second.end(), {"-f", "25-30"});
  ASSERT_EQ(resolve("in/cut.####.exr", "second", second).code, 0);
  expect_same_files("second", "cut");

  fs::remove(folder / "in/cut.0022.exr");
  const Outcome gap = resolve("in/cut.####.exr", "gap", counts);
  EXPECT_EQ(gap.code, 0) << gap.err;
  EXPECT_NE(gap.err.find("gap after frame 21"), std::string::npos) << gap.err;
  EXPECT_EQ(at("gap", 23, "varve.count-past"), 0);
  EXPECT_EQ(at("gap", 21, "varve.count-future"), 0);
  EXPECT_LE(at("gap", 21, "varve.frames"), 3);
}

TEST_F(GatherCli, OneThingWrong) {
  synth("pan", "1-3");
  const std::string in = "in/pan.####.exr";
  expect_refused(resolve(in, "o", {"--reach", "-1"}), 2, "--reach");
  expect_refused(resolve(in, "o", {"--reach", "257"}), 2, "--reach");
  expect_refused(resolve(in, "o", {"--cells", "0"}), 2, "--cells");
  expect_refused(resolve(in, "o", {"--cells", "9"}), 2, "--cells");
  expect_refused(resolve(in, "o", {"--sigma", "0"}), 2, "--sigma");
  expect_refused(resolve(in, "o", {"--sigma", "nan"}), 2, "--sigma");
  expect_refused(resolve(in, "o", {"--gain-window", "4"}), 2, "--gain-window");
  expect_refused(resolve(in, "o", {"--gain", "maybe"}), 2, "--gain");
  ASSERT_EQ(resolve(in, "o", {"--reach", "0", "--cells", "1"}).code, 0);
  fs::resize_file(folder / "in/pan.0003.exr", 400);
  expect_refused(resolve(in, "o"), 3, "pan.0003.exr");
}

}  // namespace
}  // namespace varve::test
