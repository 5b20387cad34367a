// varve resolve against the pixels: wrong vectors stop it, unknown ones are settled or refused with what was seen.
#include <gtest/gtest.h>

#include "scene_cli.h"
#include "sentence.h"

namespace varve::test {
namespace {

class CheckMotion : public SceneCli {
 protected:
  Outcome resolve(const Arguments& choices) const {
    return resolve_into("in/pan.####.exr", "out", choices, {"--progress", "none"});
  }
  const Arguments turned = {"--convention",        "varve",           "--map", "motion.x=velocity.x", "--map",
                            "motion.y=velocity.y", "--motion-sign-x", "-1",    "--motion-sign-y",     "-1"};
};

bool has(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

TEST_F(CheckMotion, VectorsTurnedRoundStopTheRunAndTheRightReadingIsNamed) {
  synth("pan", "20-23", {"--size", "160x90"});
  const Outcome outcome = resolve(turned);
  expect_refused(outcome, 4, "velocity.x");
  EXPECT_TRUE(has(outcome.err, "lead farther from where the pixels came from than no motion does")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "--convention varve")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "--check-motion off")) << outcome.err;
  Arguments believed = turned;
  believed.insert(believed.end(), {"--check-motion", "off"});
  EXPECT_EQ(resolve(believed).code, 0);
}

TEST_F(CheckMotion, RightVectorsPass) {
  synth("pan", "20-23", {"--size", "160x90"});
  const Outcome outcome = resolve({});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_FALSE(has(outcome.err, "vectors")) << outcome.err;
}

}  // namespace
}  // namespace varve::test
