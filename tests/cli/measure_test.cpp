// varve measure as a user meets it.
#include <gtest/gtest.h>

#include <filesystem>

#include "program.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

class Measure : public testing::Test {
 protected:
  void SetUp() override { write_small_sequence(folder.path(), {.frames = 4}); }
  Outcome run(const std::vector<std::string>& more) const {
    std::vector<std::string> line = {"measure", "in.####.exr", "--repeats", "1", "-q", "--scratch", "."};
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }
  Folder folder;
};

TEST_F(Measure, RanksWithoutReferenceAndLeavesNothingBehind) {
  const std::vector<std::string> before = files_below(folder.path());
  const Outcome outcome = run({"--presets", "salvi", "--sweep", "gamma=1,2", "--setting", "alpha=1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("salvi gamma=2"), std::string::npos);
  EXPECT_NE(outcome.out.find("does not tell how wrong"), std::string::npos);
  EXPECT_NE(outcome.out.find("varve resolve in.####.exr -o OUT.####.exr --preset=salvi"), std::string::npos);
  EXPECT_EQ(files_below(folder.path()), before);
}

TEST_F(Measure, ScoresTheFramesThatTheReferenceHas) {
  for (int frame : {2, 3}) write_small_frame(folder / ("ref.000" + std::to_string(frame) + ".exr"), frame);
  const Outcome outcome = run({"--presets", "salvi", "--reference", "ref.####.exr", "--leave-out", "--setting",
                               "alpha=1", "--csv", "t.csv", "--json", "t.json", "--plot", "t.svg"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("2 of the 4 frames"), std::string::npos);
  EXPECT_NE(bytes_of(folder / "t.csv").find("salvi alpha=1,"), std::string::npos);
  EXPECT_NE(bytes_of(folder / "t.json").find("\"rank_correlation\":"), std::string::npos);
  EXPECT_NE(bytes_of(folder / "t.svg").find("</svg>"), std::string::npos);
}

TEST_F(Measure, RefusesAReferenceWithNothingInCommon) {
  write_small_frame(folder / "ref.0009.exr", 9);
  const Outcome outcome = run({"--reference", "ref.####.exr"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("none in common"), std::string::npos);
  write_small_frame(folder / "wide.0002.exr", 2, {.width = 80});
  EXPECT_EQ(run({"--reference", "wide.####.exr"}).code, 4);
  EXPECT_EQ(run({"--reference", "absent.####.exr"}).code, 3);
}

TEST_F(Measure, RefusesBadSettings) {
  EXPECT_EQ(run({"--sweep", "gama=1"}).code, 2);
  EXPECT_EQ(run({"--sweep", "gamma"}).code, 2);
  EXPECT_EQ(run({"--presets", "nobody"}).code, 2);
  EXPECT_EQ(run({"--baseline", "nobody"}).code, 2);
  EXPECT_EQ(run({"--plot", "x.gif"}).code, 2);
  EXPECT_EQ(run({"--plot", "absent/x.svg"}).code, 5);
}

TEST_F(Measure, FloorCopiesThePixels) {
  std::filesystem::create_directory(folder / "copy");
  EXPECT_EQ(run_varve({"floor", "in.####.exr", "-o", "copy/in.####.exr"}, folder.path()).code, 0);
  const Outcome same = run_varve({"compare", "in.####.exr", "copy/in.####.exr", "-c", "all"}, folder.path());
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_EQ(run_varve({"floor", "in.####.exr", "-o", "in.####.exr"}, folder.path()).code, 2);
}

}  // namespace
}  // namespace varve::test
