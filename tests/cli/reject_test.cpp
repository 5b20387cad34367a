// Rejection, weights, fallbacks and cuts as a user reaches them.
#include <gtest/gtest.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <regex>

#include "program.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

/// A wall of 1 at frame 1 and of 0 at frame 2 with every channel that a test could want. At (5, 4) of frame 2 all of
/// them differ.
void write_pair(const fs::path& folder) {
  constexpr int w = 16, h = 12;
  for (const int frame : {1, 2}) {
    const auto all = [](float value) { return std::vector<float>(std::size_t(w * h), value); };
    std::vector<float> color = all(frame == 1 ? 1.0f : 0.0f), z = all(5), x = all(0), y = all(0), nx = all(0),
                       nz = all(1), mask = all(0), factor = all(1);
    std::vector<unsigned> id(std::size_t(w * h), 70000001u);
    if (frame == 2) {
      const std::size_t odd = 4 * w + 5;
      z[odd] = 9, x[odd] = 0.75f, nx[odd] = 1, nz[odd] = 0, mask[odd] = 1, factor[odd] = 5, id[odd] = 70000002u;
    }
    Imf::Header header(w, h);
    header.insert("varve:motion", Imf::StringAttribute("varve"));
    Imf::FrameBuffer pixels;
    const auto add = [&](const char* name, Imf::PixelType type, auto& values) {
      header.channels().insert(name, Imf::Channel(type));
      pixels.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), 4, 4 * w));
    };
    for (const char* name : {"R", "G", "B"}) add(name, Imf::FLOAT, color);
    add("Z", Imf::FLOAT, z);
    add("velocity.x", Imf::FLOAT, x);
    add("velocity.y", Imf::FLOAT, y);
    add("Normal.X", Imf::FLOAT, nx);
    add("Normal.Y", Imf::FLOAT, y);
    add("Normal.Z", Imf::FLOAT, nz);
    add("objectId", Imf::UINT, id);
    add("mask", Imf::FLOAT, mask);
    add("factor", Imf::FLOAT, factor);
    Imf::OutputFile file((folder / ("w.000" + std::to_string(frame) + ".exr")).c_str(), header);
    file.setFrameBuffer(pixels);
    file.writePixels(h);
  }
}

class Reject : public testing::Test {
 protected:
  void SetUp() override {
    write_pair(folder.path());
    fs::create_directory(folder / "o");
  }
  Outcome run(const Arguments& more) {
    Arguments line = {"resolve", "w.####.exr", "-o",           "o/o.####.exr", "--box",      "none",
                      "--alpha", "0.1",        "--alpha-rule", "fixed",        "--dilation", "none",
                      "--aov",   "reject",     "--report",     "r.json"};
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }
  float out(const std::string& channel, int x, int y) { return pixel_of(folder / "o/o.0002.exr", channel, x, y); }
  /// A field of the report's row of frame 2.
  double reported(const std::string& field) {
    const std::string text = bytes_of(folder / "r.json");
    std::smatch found;
    const std::string row = text.substr(text.find("\"frame\":2"));
    return std::regex_search(row, found, std::regex("\"" + field + "\":([0-9]+)")) ? std::stod(found[1]) : -1;
  }
  Folder folder;
};

TEST_F(Reject, EveryTestHasItsOptionItsBitAndItsCount) {
  struct Case {
    Arguments options;
    const char* name;
    float bit;
  };
  for (const Case& c : std::vector<Case>{{{"--disocclusion", "depth"}, "depth", 8},
                                         {{"--disocclusion", "depth", "--depth-slope", "0.5"}, "depth", 8},
                                         {{"--normal-angle", "30"}, "normal", 128},
                                         {{"--id-test", "hard"}, "id", 256},
                                         {{"--id-test", "soft"}, "id", 256},
                                         {{"--speed-difference", "0.5"}, "speed", 512},
                                         {{"--acceleration", "0.7", "--acceleration-low", "0.1"}, "acceleration", 2048},
                                         {{"--map", "reactive=mask"}, "reactive", 4096}}) {
    const Outcome outcome = run(c.options);
    ASSERT_EQ(outcome.code, 0) << c.name << outcome.err;
    EXPECT_EQ(out("varve.reject", 5, 4), c.bit) << c.name;
    EXPECT_EQ(out("G", 5, 4), 0.0f) << c.name;
    EXPECT_EQ(out("varve.reject", 9, 9), 0.0f) << c.name;
    EXPECT_NEAR(out("G", 9, 9), 0.9f, 1e-6f) << c.name;
    EXPECT_EQ(reported(std::string("rejected_") + c.name), 1) << c.name;
  }
  // What rested before has no direction; see tests/unit/reject_test.cpp for what moved.
  ASSERT_EQ(run({"--direction-angle", "30"}).code, 0);
  EXPECT_EQ(out("varve.reject", 5, 4), 0.0f);
  ASSERT_EQ(run({}).code, 0);
  EXPECT_NEAR(out("G", 5, 4), 0.9f, 1e-6f);
  for (const char* name : {"depth", "normal", "id", "speed", "direction", "acceleration", "reactive"})
    EXPECT_EQ(reported(std::string("rejected_") + name), 0) << name;
}

TEST_F(Reject, OnRejectAndWeightsChangeThePixel) {
  ASSERT_EQ(run({"--id-test", "hard", "--on-reject", "weight", "--reject-alpha", "0.25"}).code, 0);
  EXPECT_NEAR(out("G", 5, 4), 0.75f, 1e-6f);
  ASSERT_EQ(run({"--id-test", "hard", "--on-reject", "blur"}).code, 0);
  EXPECT_EQ(out("G", 5, 4), 0.0f);
  ASSERT_EQ(run({"--map", "responsive=factor"}).code, 0);
  EXPECT_NEAR(out("G", 5, 4), 0.5f, 1e-6f);
  ASSERT_EQ(run({"--map", "reactive=mask", "--reactive", "0.5"}).code, 0);
  EXPECT_NEAR(out("G", 5, 4), 0.45f, 1e-6f);
  ASSERT_EQ(run({"--speed-alpha", "0.5", "--full-speed", "0.75"}).code, 0);
  EXPECT_NEAR(out("G", 5, 4), 0.5f, 1e-6f);
  ASSERT_EQ(run({"--feedback", "luma", "--feedback-low", "0.6"}).code, 0);
  EXPECT_NEAR(out("G", 9, 9), 0.6f, 1e-6f);
  ASSERT_EQ(run({"--weighing", "luminance"}).code, 0);
  EXPECT_NEAR(out("G", 9, 9), 0.45 / (0.45 + 0.1), 1e-5);
  ASSERT_EQ(run({"--weighing", "log", "--exposure", "1"}).code, 0);
  EXPECT_NEAR(out("G", 9, 9), std::expm1(0.9 * std::log1p(2.0)) / 2, 1e-5);
  ASSERT_EQ(run({"--anti-flicker", "1"}).code, 0);
  EXPECT_NEAR(out("G", 9, 9), 0.9f, 1e-6f);  // a flat patch has no wall near
}

TEST_F(Reject, FallbacksAreOutputOnly) {
  ASSERT_EQ(run({"--blur-young", "1"}).code, 0);
  EXPECT_NEAR(out("G", 9, 9), 0.9f, 1e-6f);
  ASSERT_EQ(run({"--motion-blur", "own", "--motion-blur-from", "0.25", "--motion-blur-to", "1.25"}).code, 0);
  EXPECT_NEAR(out("G", 5, 4), 0.45f, 1e-6f);  // halfway to the present
  EXPECT_NEAR(out("G", 9, 9), 0.9f, 1e-6f);
  ASSERT_EQ(run({"--motion-blur", "neighbors", "--motion-blur-from", "0.25", "--motion-blur-to", "1.25"}).code, 0);
  EXPECT_NEAR(out("G", 9, 9), 0.45f, 1e-6f);
}

TEST_F(Reject, WhatIsMissingIsRefusedWithTheRemedy) {
  Folder bare;
  write_small_sequence(bare.path(), {.frames = 2, .with_vectors = false});
  fs::create_directory(bare / "o");
  const auto refused = [&](Arguments more, const std::string& remedy, int code) {
    Arguments line = {"resolve", "in.####.exr", "-o", "o/o.####.exr", "--convention", "none"};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome outcome = run_varve(line, bare.path());
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_NE(outcome.err.find(remedy), std::string::npos) << outcome.err;
    EXPECT_TRUE(files_below(bare / "o").empty());
  };
  refused({"--normal-angle", "20"}, "--map normal.x=CHANNEL", 4);
  refused({"--acceleration", "2"}, "--map motion.x=CHANNEL", 4);
  refused({"--map", "reactive=nothing"}, "there is no such channel", 4);
  refused({"--map", "normal.x=ViewLayer.Depth.Z"}, "normal.y", 4);
  refused({"--depth-slope", "2"}, "--disocclusion depth", 2);
  refused({"--id-test", "maybe"}, "--id-test", 2);
  Arguments fine = {"resolve", "in.####.exr", "-o", "o/o.####.exr", "--convention", "none", "--id-test", "hard"};
  EXPECT_EQ(run_varve(fine, bare.path()).code, 0);  // IndexOB is told by its name
}

TEST_F(Reject, ThePlanSaysWhatRunsAndReadsOnlyThat) {
  Arguments line = {"resolve", "w.####.exr", "-o", "o/o.####.exr", "--dry-run"};
  EXPECT_NE(run_varve(line, folder.path()).out.find("id (not needed)"), std::string::npos);
  line.insert(line.end(), {"--id-test", "soft", "--acceleration", "3", "--map", "reactive=mask"});
  const std::string plan = run_varve(line, folder.path()).out;
  EXPECT_EQ(plan.find(" id (not needed)"), std::string::npos);
  EXPECT_NE(plan.find("ids with soft edges"), std::string::npos);
  EXPECT_NE(plan.find("the reactive mask"), std::string::npos);
}

TEST(FindCuts, OnTellsTheEvidenceAndOffLetsHistoryPass) {
  Folder folder;
  fs::create_directory(folder / "o");
  ASSERT_EQ(run_varve({"synth", "cut", "-o", "s", "-f", "23-27", "-q"}, folder.path()).code, 0);
  const Arguments line = {"resolve", "s/cut.####.exr", "-o", "o/o.####.exr", "--aov", "reject", "--keep", "none"};
  Outcome outcome = run_varve(line, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(pixel_of(folder / "o/o.0025.exr", "varve.reject", 160, 90), 0.0f);
  Arguments on = line;
  on.insert(on.end(), {"--find-cuts", "on", "--blur-young", "3"});
  outcome = run_varve(on, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: frame 25 is taken for the first of a new shot"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("restart (cut found: "), std::string::npos);
  EXPECT_EQ(pixel_of(folder / "o/o.0025.exr", "varve.reject", 160, 90), 2.0f);
  EXPECT_EQ(pixel_of(folder / "o/o.0026.exr", "varve.reject", 160, 90), 0.0f);
  // The frames that a frame was made from are told as they were.
  EXPECT_NE(bytes_of(folder / "o/o.0027.exr").find("25-27"), std::string::npos);
  EXPECT_EQ(bytes_of(folder / "o/o.0027.exr").find("23-27"), std::string::npos);
  // A cut that is given needs no evidence and gives the same pixels.
  Arguments given = line;
  given[3] = "o/g.####.exr";
  given.insert(given.end(), {"--cuts", "25", "--blur-young", "3"});
  ASSERT_EQ(run_varve(given, folder.path()).code, 0);
  for (const int x : {3, 160, 300})
    EXPECT_EQ(pixel_of(folder / "o/g.0026.exr", "G", x, 90), pixel_of(folder / "o/o.0026.exr", "G", x, 90));
}

}  // namespace
}  // namespace varve::test
