#include "plan/probe.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "base/json.h"
#include "paths.h"
#include "plan/describe.h"
#include "support/refusal.h"

namespace varve {
namespace {

namespace fs = std::filesystem;
const std::string kData = VARVE_DATA;

#define NEED_DATA() \
  if (!fs::exists(kData)) GTEST_SKIP() << "no development data"

using test::message_of;

InputSequence input_of(const std::string& text) { return {SequencePattern::parse(text), {}}; }

SequenceInfo probe(const std::string& text, const std::string& convention = "auto", const std::vector<int>& frames = {},
                   const std::string& jitter = "auto") {
  RoleRequest roles;
  roles.convention = convention;
  return probe_sequence(input_of(text), frames, roles, parse_jitter_source(jitter));
}

bool mentions(const std::vector<std::string>& notes, const std::string& word) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& n) { return n.find(word) != std::string::npos; });
}

/// A folder of copied frames that is gone when the test is over.
struct Folder {
  Folder() : path(fs::temp_directory_path() / ("varve_probe_" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  void copy(const std::string& from, const std::string& to) {
    fs::copy_file(kData + from, path / to, fs::copy_options::overwrite_existing);
  }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  fs::path path;
};

TEST(Probe, Courtyard) {
  NEED_DATA();
  const SequenceInfo info = probe(kData + "/courtyard/jit/frame.####.exr");
  EXPECT_EQ(format_frame_list(info.frames), "1-16");
  EXPECT_TRUE(info.gaps.empty());
  EXPECT_EQ(info.frames_with_jitter, 16);
  EXPECT_EQ(info.frames_with_camera, 16);
  EXPECT_NE(info.camera.find("Note"), std::string::npos);
  EXPECT_FALSE(info.windows_move || info.windows_differ);
  EXPECT_TRUE(info.notes.empty());
  EXPECT_NEAR(info.first.jitter->y, -0.166667, 1e-9);
  EXPECT_EQ(info.first.frame, 1);
}

TEST(Probe, BeachballMoves) {
  NEED_DATA();
  const SequenceInfo info = probe(kData + "/beachball/singlepart.####.exr");
  EXPECT_TRUE(info.windows_move);
  EXPECT_FALSE(info.windows_differ);
  EXPECT_EQ(info.frames_with_jitter, 0);
  EXPECT_EQ(info.jitter_source, "none found");
  EXPECT_EQ(info.camera, "none found");
  EXPECT_TRUE(mentions(info.notes, "half"));
  EXPECT_EQ(info.first.subjects.size(), 2u);
}

TEST(Probe, JitterOfEveryPartAndSource) {
  NEED_DATA();
  const std::string frames = kData + "/samples4/jit/frame.####.exr";
  EXPECT_NEAR(probe(frames, "varve").first.jitter->x, 0.03125, 1e-9);
  RoleRequest roles;
  roles.convention = "varve";
  roles.layers = {"sample.1"};
  EXPECT_NEAR(read_frame_headers(input_of(frames), 5, roles, {}).jitter->x, -0.21875, 1e-9);
  const SequenceInfo table = probe(frames, "varve", {}, kData + "/samples4/jit/jitter.csv");
  EXPECT_EQ(table.frames_with_jitter, 6);
  EXPECT_NE(table.jitter_source.find("sample 0"), std::string::npos);
  EXPECT_EQ(probe(frames, "varve", {}, "none").frames_with_jitter, 0);
  EXPECT_NE(message_of([&] { probe(frames); }, ExitCode::inconsistent).find("frame 5"), std::string::npos);
}

TEST(Probe, GapsDifferencesAndTheSidecarBeside) {
  NEED_DATA();
  Folder folder;
  for (const char* frame : {"0001", "0002", "0004", "0007"})
    folder.copy("/extremes/BrightRingsNanInf.exr", std::string("a.") + frame + ".exr");
  folder.copy("/courtyard/jit/jitter.csv", "jitter.csv");
  SequenceInfo info = probe(folder / "a.####.exr");
  EXPECT_EQ(info.gaps, (std::vector<int>{3, 5, 6}));
  EXPECT_TRUE(mentions(info.notes, "--jitter " + (folder / "jitter.csv")));
  EXPECT_EQ(info.frames_with_jitter, 0);  // lying there is no permission
  EXPECT_EQ(probe(folder / "a.####.exr", "auto", {}, folder / "jitter.csv").frames_with_jitter, 4);
  EXPECT_FALSE(mentions(probe(folder / "a.####.exr", "auto", {}, "none").notes, "--jitter"));

  info = probe(folder / "a.####.exr", "auto", {1, 4, 7});
  EXPECT_TRUE(info.gaps.empty());  // every third frame
  EXPECT_TRUE(mentions(info.notes, "3 apart"));

  folder.copy("/courtyard/jit/frame.0004.exr", "a.0004.exr");
  info = probe(folder / "a.####.exr");
  EXPECT_TRUE(mentions(info.notes, "frame 4: the channels differ"));
  EXPECT_TRUE(mentions(info.notes, "ViewLayer.Combined.A"));
  EXPECT_TRUE(mentions(info.notes, "1 of 4 frames only"));
}

TEST(Probe, FarApartFramesStayBounded) {
  NEED_DATA();
  Folder folder;
  for (const char* frame : {"-2147483648", "0", "1", "2147483647"})
    folder.copy("/courtyard/ref/frame.0005.exr", std::string("a.") + frame + ".exr");
  EXPECT_LE(probe(folder / "a.%d.exr").gaps.size(), 100000u);
}

TEST(Probe, WhatIsMissingOrBrokenIsNamed) {
  NEED_DATA();
  Folder folder;
  message_of([&] { probe(folder / "a.####.exr"); }, ExitCode::input);
  message_of([&] { probe(folder / "still.exr"); }, ExitCode::input);
  folder.copy("/courtyard/ref/frame.0005.exr", "a.0001.exr");
  EXPECT_NE(message_of(
                [&] {
                  probe(folder / "a.####.exr", "auto", {1, 2});
                },
                ExitCode::input)
                .find("frame 2"),
            std::string::npos);
  std::ofstream(folder / "a.0002.exr") << "not a picture";
  const std::string message = message_of([&] { probe(folder / "a.####.exr"); }, ExitCode::input);
  EXPECT_NE(message.find("frame 2"), std::string::npos);
  EXPECT_NE(message.find("a.0002.exr"), std::string::npos);
  message_of([&] { probe(folder / "a.0001.exr", "auto", {1, 2}); }, ExitCode::usage);
  EXPECT_EQ(probe(folder / "a.0001.exr").frames, std::vector<int>{1});
}

TEST(Probe, RoleFilesLieBesideTheColor) {
  NEED_DATA();
  InputSequence input = input_of(kData + "/courtyard/ref/frame.####.exr");
  input.roles.push_back(SequencePattern::parse(kData + "/courtyard/jit/frame.####.exr"));
  const SequenceInfo info = probe_sequence(input, {5, 6}, {}, {});
  ASSERT_EQ(info.first.files.size(), 2u);
  ASSERT_TRUE(info.first.subjects[0].depth && info.first.subjects[0].backward);
  EXPECT_EQ(info.first.subjects[0].depth->file, 1);
  EXPECT_EQ((*info.first.subjects[0].backward)[0].file, 1);
}

TEST(MeasurePixels, AgreesWithWhatTheFilesHold) {
  NEED_DATA();
  Workers workers(2);
  const InputSequence rings = input_of(kData + "/extremes/BrightRingsNanInf.exr");
  const SequenceInfo info = probe_sequence(rings, {}, {}, {});
  const std::vector<ChannelStatistics> found = measure_pixels(info, rings, {}, {}, 3, workers);
  ASSERT_EQ(found.size(), 3u);
  for (const ChannelStatistics& s : found) {
    EXPECT_EQ(s.pixels, 640000u);
    EXPECT_EQ(s.not_finite, 6u);  // 2 NaN and 4 Inf, by the data's description
    EXPECT_TRUE(std::isfinite(s.least) && std::isfinite(s.greatest) && std::isfinite(s.mean));
    EXPECT_LE(s.least, s.mean);
    EXPECT_LE(s.mean, s.greatest);
  }
  EXPECT_TRUE(mentions(findings(info, found), "not finite"));
  EXPECT_TRUE(measure_pixels(info, rings, {}, {}, 0, workers).empty());
}

TEST(Findings, TellStillConstantAndLongVectors) {
  NEED_DATA();
  const SequenceInfo info = probe(kData + "/beachball/singlepart.####.exr");
  const auto vector = [](double least, double greatest, std::size_t zero) {
    return std::vector<ChannelStatistics>{
        {1, "rgba", "forward.right.u", "forward.x", least, greatest, 0, 100, 0, zero}};
  };
  EXPECT_TRUE(mentions(findings(info, vector(0, 0, 100)), "renderer wrote no vectors"));
  EXPECT_TRUE(mentions(findings(info, vector(0.5, 0.5, 0)), "0.5 everywhere"));
  EXPECT_TRUE(mentions(findings(info, vector(-3, 60000, 0)), "too long"));
  EXPECT_TRUE(mentions(findings(info, vector(-3, 43, 0)), "0.03125"));
  EXPECT_TRUE(mentions(findings(info, vector(-70, 1, 0)), "0.0625"));
  EXPECT_TRUE(findings(info, vector(-3, 4, 0)).empty());
  EXPECT_TRUE(findings(info, {}).empty());
}

}  // namespace
}  // namespace varve
