#include "exr/sequence.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "base/error.h"

namespace varve {
namespace {

constexpr int kMin = std::numeric_limits<int>::min(), kMax = std::numeric_limits<int>::max();

ExitCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Failure& failure) {
    return failure.code();
  }
  return ExitCode::done;
}

TEST(SequencePattern, WritesTheFrameInEverySpelling) {
  EXPECT_EQ(SequencePattern::parse("a/shot.####.exr").path(7), "a/shot.0007.exr");
  EXPECT_EQ(SequencePattern::parse("shot.#.exr").path(7), "shot.0007.exr");
  EXPECT_EQ(SequencePattern::parse("shot.##.exr").path(7), "shot.07.exr");
  EXPECT_EQ(SequencePattern::parse("shot.@@@.exr").path(7), "shot.007.exr");
  EXPECT_EQ(SequencePattern::parse("shot.@.exr").path(7), "shot.7.exr");
  EXPECT_EQ(SequencePattern::parse("shot.%06d.exr").path(7), "shot.000007.exr");
  EXPECT_EQ(SequencePattern::parse("shot.%d.exr").path(12345), "shot.12345.exr");
  EXPECT_EQ(SequencePattern::parse("shot.$F4.exr").path(7), "shot.0007.exr");
  EXPECT_EQ(SequencePattern::parse("shot.$F.exr").path(7), "shot.7.exr");
  EXPECT_EQ(SequencePattern::parse("shot.####.exr").path(-7), "shot.-0007.exr");
  EXPECT_EQ(SequencePattern::parse("shot.####.exr").path(123456), "shot.123456.exr");
  EXPECT_EQ(SequencePattern::parse("s.%d.exr").path(kMin), "s.-2147483648.exr");
  EXPECT_EQ(SequencePattern::parse("s.%d.exr").path(kMax), "s.2147483647.exr");
}

TEST(SequencePattern, OnlyTheLastPlaceholderOfTheFileNameCounts) {
  EXPECT_EQ(SequencePattern::parse("v##_####.exr").path(3), "v##_0003.exr");
  EXPECT_EQ(SequencePattern::parse("d####/x.%03d.exr").path(3), "d####/x.003.exr");
  EXPECT_FALSE(SequencePattern::parse("d####/x.exr").has_frame());
  EXPECT_FALSE(SequencePattern::parse("x.$FF.exr").has_frame());
  EXPECT_FALSE(SequencePattern::parse("x.%s.100%.exr").has_frame());
  EXPECT_EQ(SequencePattern::parse("still.exr").path(99), "still.exr");
}

TEST(SequencePattern, RefusesWhatCannotBeAName) {
  EXPECT_EQ(code_of([] { SequencePattern::parse(""); }), ExitCode::usage);
  EXPECT_EQ(code_of([] { SequencePattern::parse("x.%017d.exr"); }), ExitCode::usage);
  EXPECT_EQ(code_of([] { SequencePattern::parse("x.%099999999999999999999d.exr"); }), ExitCode::usage);
  EXPECT_EQ(code_of([] { SequencePattern::parse("x." + std::string(17, '#') + ".exr"); }), ExitCode::usage);
  EXPECT_EQ(SequencePattern::parse("x.%016d.exr").path(1), "x.0000000000000001.exr");
}

class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("varve_sequence_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void touch(const std::string& name) { std::ofstream(folder_ / name) << "x"; }
  std::vector<int> frames(const std::string& name) {
    return SequencePattern::parse((folder_ / name).string()).frames_on_disk();
  }
  std::filesystem::path folder_;
};

TEST_F(FolderTest, FindsTheFramesThatPathWouldOpen) {
  for (const char* name : {"a.0001.exr", "a.0010.exr", "a.-0003.exr", "a.12345.exr", "a.exr", "a.1.exr", "a.00020.exr",
                           "a.0001.exr.tmp", "b.0002.exr", "a.0005x.exr", "a.-0000.exr", "a.99999999999.exr", "a..exr"})
    touch(name);
  std::filesystem::create_directories(folder_ / "a.0099.exr");
  EXPECT_EQ(frames("a.####.exr"), (std::vector<int>{-3, 1, 10, 12345}));
  EXPECT_EQ(frames("a.%d.exr"), (std::vector<int>{1, 12345}));
  EXPECT_EQ(frames("nothing.####.exr"), std::vector<int>{});
  EXPECT_EQ(frames("no/folder/a.####.exr"), std::vector<int>{});
  EXPECT_EQ(frames("a.exr"), std::vector<int>{1});
  EXPECT_EQ(frames("c.exr"), std::vector<int>{});
}

TEST_F(FolderTest, CharactersOfGlobsAreTakenAsTheyAre) {
  for (const char* name : {"a[1]*?.0004.exr", "a1xx.0005.exr"}) touch(name);
  EXPECT_EQ(frames("a[1]*?.####.exr"), std::vector<int>{4});
}

TEST(FrameList, ReadsEveryForm) {
  EXPECT_EQ(parse_frame_list("7"), std::vector<int>{7});
  EXPECT_EQ(parse_frame_list("-7"), std::vector<int>{-7});
  EXPECT_EQ(parse_frame_list("3-5,1"), (std::vector<int>{1, 3, 4, 5}));
  EXPECT_EQ(parse_frame_list("1-10x4, 5,5"), (std::vector<int>{1, 5, 9}));
  EXPECT_EQ(parse_frame_list("-10--8"), (std::vector<int>{-10, -9, -8}));
  EXPECT_EQ(parse_frame_list("-1-1"), (std::vector<int>{-1, 0, 1}));
  EXPECT_EQ(parse_frame_list("2147483646-2147483647"), (std::vector<int>{kMax - 1, kMax}));
  EXPECT_EQ(parse_frame_list("-2147483648-2147483647x2147483647"), (std::vector<int>{kMin, -1, kMax - 1}));
}

TEST(FrameList, RefusesAnythingElse) {
  for (const char* text : {"",
                           ",",
                           "1,",
                           "a",
                           "1-",
                           "1-5x",
                           "1-5x0",
                           "1-5x-1",
                           "1x2",
                           "5-1",
                           "1-5y2",
                           "1 2",
                           "1.5",
                           "0x10",
                           "1-5x2 x",
                           "2147483648",
                           "1-2147483647",
                           "-2147483648-2147483647",
                           "1--",
                           "--1",
                           "+1",
                           "1e3",
                           "1-9000000,1-9000000"})
    EXPECT_EQ(code_of([&] { parse_frame_list(text); }), ExitCode::usage) << text;
}

TEST(FrameList, NamesThePartThatCannotBeRead) {
  try {
    parse_frame_list("1-10,banana,3");
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("banana"), std::string::npos);
  }
}

TEST(FrameList, TextReadsBackAsTheSameFrames) {
  std::mt19937 random(1);
  for (int round = 0; round < 500; ++round) {
    std::vector<int> frames;
    int frame = round % 3 == 0 ? kMin : -20;
    for (int i = 0; i < 30; ++i) {
      frames.push_back(frame);
      frame += 1 + int(random() % (round % 2 ? 2 : 5));
    }
    EXPECT_EQ(parse_frame_list(format_frame_list(frames)), frames);
  }
  const std::vector<int> wide = {kMin, -1, kMax};
  EXPECT_EQ(parse_frame_list(format_frame_list(wide)), wide);
  EXPECT_EQ(format_frame_list({}), "");
}

TEST(FrameList, TextIsShort) {
  EXPECT_EQ(format_frame_list(parse_frame_list("1-10,20,30-50x2")), "1-10,20,30-50x2");
  EXPECT_EQ(format_frame_list({4, 5}), "4,5");
  EXPECT_EQ(format_frame_list({3, 1, 2, 2}), "1-3");
  EXPECT_EQ(format_frame_list({-3, -2, -1, 0}), "-3-0");
}

}  // namespace
}  // namespace varve
