// varve synth as a user meets it, and its files as varve resolve meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "program.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

class Synth : public testing::Test {
 protected:
  Outcome run(const Arguments& more) const {
    Arguments line = {"synth"};
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }
  Folder folder;
};

TEST_F(Synth, WritesWhatIsAskedFor) {
  const Outcome outcome = run({"crossing", "-o", "out", "--size", "64x36", "-f", "2-4", "--truth", "box",
                               "--truth-samples", "4", "--yardsticks", "2,3"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("PROGRESS: 100%"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("rror"), std::string::npos);
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder.path()).string());
  std::sort(names.begin(), names.end());
  Arguments expected = {"out/jitter.csv"};
  for (const std::string below : {"", "ss2/", "ss3/", "truth/"})
    for (const std::string frame : {"2", "3", "4"})
      expected.push_back("out/" + below + "crossing.000" + frame + ".exr");
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names, expected);
  for (const std::string& name : names) EXPECT_TRUE(name.ends_with(".csv") || is_complete(folder / name)) << name;
}

TEST_F(Synth, ResolveAndProbeReadItAsItIs) {
  for (const Arguments& more : {Arguments{}, {"--layers"}, {"--samples", "2"}}) {
    Arguments line = {"panes", "-o", "in", "--size", "64x36", "-f", "1-3"};
    line.insert(line.end(), more.begin(), more.end());
    ASSERT_EQ(run(line).code, 0);
    const Outcome probe = run_varve({"probe", "in/panes.####.exr"}, folder.path());
    EXPECT_EQ(probe.code, 0) << probe.err;
    for (const char* word : {"velocity.x", "forward.x", "varve:motion", "jitter"})
      EXPECT_NE(probe.out.find(word), std::string::npos) << word << "\n" << probe.out;
    const Outcome resolve = run_varve({"resolve", "in/panes.####.exr", "-o", "res.####.exr"}, folder.path());
    EXPECT_EQ(resolve.code, 0) << resolve.err;
  }
}

TEST_F(Synth, EverySceneCanBeWritten) {
  const std::string scenes = run_varve({"help", "scenes"}).out;
  int count = 0;
  std::istringstream lines(scenes);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 3 || line[2] == ' ' || !line.starts_with("  ")) continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    const Outcome outcome = run({name, "-o", name, "--size", "32x18", "-f", "1,25", "-q"});
    EXPECT_EQ(outcome.code, 0) << name << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(is_complete(folder / (name + "/" + name + ".0025.exr"))) << name;
    ++count;
  }
  EXPECT_GE(count, 27);
}

TEST_F(Synth, OddFramesAndSizes) {
  EXPECT_EQ(run({"quality-all", "-o", "o", "--size", "1x1", "-f", "-5,0,100000", "-q"}).code, 0);
  EXPECT_TRUE(is_complete(folder / "o/quality-all.-0005.exr"));
  EXPECT_TRUE(is_complete(folder / "o/quality-all.100000.exr"));
}

TEST_F(Synth, OneThingWrong) {
  expect_refused(run({"courtyard", "-o", "out"}), 2, "quality-all");
  expect_refused(run({"pan"}), 2, "--output");
  expect_refused(run({"pan", "-o", "out", "--jitter", "auto"}), 2, "auto");
  expect_refused(run({"pan", "-o", "out", "--jitter", "none.csv"}), 3, "none.csv");
  expect_refused(run({"pan", "-o", "out", "--layers"}), 4, "pan");
  expect_refused(run({"panes", "-o", "out", "--layers", "--samples", "2"}), 2, "--samples");
  for (const char* size : {"320", "0x5", "x", "320x", "-1x4", "20000x4", "4x4x4"})
    expect_refused(run({"pan", "-o", "out", "--size", size}), 2, "--size");
  expect_refused(run({"pan", "-o", "out", "--size", "16384x16384"}), 2, "--size");
  expect_refused(run({"pan", "-o", "out", "--yardsticks", "2,0"}), 2, "--yardsticks");
  EXPECT_FALSE(fs::exists(folder / "out"));
  std::ofstream(folder / "file") << "no folder";
  expect_refused(run({"pan", "-o", "file", "-f", "1"}), 5, "file");
}

}  // namespace
}  // namespace varve::test
