// varve probe on a small sequence.
#include <gtest/gtest.h>

#include <fstream>

#include "program.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

class Probe : public testing::Test {
 protected:
  void SetUp() override { write_small_sequence(folder.path()); }
  Outcome run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> line = {"probe", "in.####.exr"};
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }
  Folder folder;
};

TEST_F(Probe, TellsWhatIsThere) {
  const Outcome outcome = run();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word : {"1-8", "cycles", "64", "48", "ViewLayer.Depth.Z", "ViewLayer.Vector.X"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << "\n" << outcome.out;
  EXPECT_TRUE(outcome.out.ends_with('\n'));
}

TEST_F(Probe, ReadsPixelsWhenAsked) {
  const Outcome outcome = run({"--pixels", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(outcome.out.size(), run().out.size());
}

TEST_F(Probe, PrintsOneJsonObject) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--json"}, {"--json", "--pixels=1"}}) {
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(outcome.out.starts_with('{') && outcome.out.ends_with("}\n")) << outcome.out;
  }
}

TEST_F(Probe, OneThingDamaged) {
  expect_refused(run({"--frames", "1-9"}), 3, "in.0009.exr");
  expect_refused(run({"--layer", "fog"}), 4, "fog");
  expect_refused(run({"--motion-file", "v.####.exr"}), 3, "v.0001.exr");
  std::ofstream(folder / "in.0003.exr") << "this is no picture";
  expect_refused(run(), 3, "in.0003.exr");
}

}  // namespace
}  // namespace varve::test
