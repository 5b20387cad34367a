#include "exr/color_space.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "base/error.h"

namespace varve {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A matrix space, a power space, a space with an offset, one whose file is missing, and a display with two views.
constexpr const char* kConfig = R"(ocio_profile_version: 2
strictparsing: true
roles:
  default: working
  scene_linear: working
displays:
  screen:
    - !<View> {name: Plain, colorspace: power}
    - !<View> {name: Raw, colorspace: working}
  wall:
    - !<View> {name: Wide, colorspace: wide}
colorspaces:
  - !<ColorSpace>
    name: working
  - !<ColorSpace>
    name: wide
    to_scene_reference: !<MatrixTransform> {matrix: [0.5, 0.25, 0.25, 0, 0.25, 0.5, 0.25, 0, 0, 0.5, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: power
    to_scene_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}
  - !<ColorSpace>
    name: lifted
    to_scene_reference: !<MatrixTransform> {matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], offset: [0.5, 0.5, 0.5, 0]}
  - !<ColorSpace>
    name: lost
    to_scene_reference: !<FileTransform> {src: lost.spi1d}
)";

class ColorSpaces : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("varve_color_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    config_ = (folder_ / "config.ocio").string();
    std::ofstream(config_) << kConfig;
    unsetenv("OCIO");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Plane<glm::vec4> converted(const std::string& from, const std::string& to, std::initializer_list<glm::vec4> pixels) {
    Plane<glm::vec4> plane(Window{-2, 5, -2 + int(pixels.size()), 6}, 1, glm::vec4(7.f));
    std::copy(pixels.begin(), pixels.end(), plane.row(5));
    ColorConversion::between(config_, from, to).apply(plane, workers_);
    return plane;
  }

  std::string failure(ExitCode code, const std::string& config, const std::string& from, const std::string& to) {
    try {
      ColorConversion::between(config, from, to);
    } catch (const Failure& f) {
      EXPECT_EQ(f.code(), code) << f.what();
      return f.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
  }

  std::filesystem::path folder_;
  std::string config_;
  Workers workers_{2};
};

void expect_near(const glm::vec4& value, const glm::vec4& truth, float relative = 2e-6f) {
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(value[c], truth[c], relative * std::max(1.f, std::abs(truth[c]))) << c;
}

TEST_F(ColorSpaces, MatrixIsAppliedToPremultipliedColorAsItIs) {
  const auto plane = converted("wide", "", {{1.f, 2.f, 4.f, 0.001f}, {1.f, 2.f, 4.f, 0.f}, {-1.f, 0.f, 3e4f, 1.f}});
  expect_near(plane.at(-2, 5), {2.f, 2.25f, 3.f, 0.001f});
  expect_near(plane.at(-1, 5), {2.f, 2.25f, 3.f, 0.f});  // emission without alpha is color too
  expect_near(plane.at(0, 5), {7499.5f, 7499.75f, 15000.f, 1.f});
}

TEST_F(ColorSpaces, PowerIsAppliedToTheColorUnderTheAlpha) {
  const auto plane =
      converted("power", "", {{0.5f, 0.25f, 1.f, 1.f}, {0.25f, 0.1f, 0.f, 0.5f}, {0.5f, 0.25f, 1.f, 0.f}});
  expect_near(plane.at(-2, 5), {0.25f, 0.0625f, 1.f, 1.f});
  expect_near(plane.at(-1, 5), {0.125f, 0.02f, 0.f, 0.5f});  // (0.25 / 0.5)^2 * 0.5
  expect_near(plane.at(0, 5), {0.25f, 0.0625f, 1.f, 0.f});   // nothing to divide by
}

TEST_F(ColorSpaces, OffsetsAreNotLinear) {
  const auto plane = converted("lifted", "", {{0.25f, 0.f, 0.f, 0.25f}});
  expect_near(plane.at(-2, 5), {0.375f, 0.125f, 0.125f, 0.25f});  // (1 + 0.5) * 0.25, 0.5 * 0.25
}

TEST_F(ColorSpaces, ThereAndBackIsTheIdentity) {
  for (const char* space : {"wide", "power", "lifted"}) {
    auto plane = converted(space, "", {{0.9f, 0.4f, 0.3f, 0.75f}});
    ColorConversion::between(config_, "", space).apply(plane, workers_);
    expect_near(plane.at(-2, 5), {0.9f, 0.4f, 0.3f, 0.75f}, 1e-5f);
  }
}

TEST_F(ColorSpaces, OnePoisonedPixelStaysAlone) {
  for (const char* space : {"wide", "power"}) {
    const glm::vec4 good(0.5f, 0.25f, 0.125f, 1.f);
    const auto clean = converted(space, "", {good, good, good, good, good, good});
    const auto plane =
        converted(space, "", {good, {kNan, 1.f, 1.f, 1.f}, good, {kInf, -kInf, 1.f, 1.f}, good, {1.f, 1.f, 1.f, kNan}});
    for (int x : {-2, 0, 2})
      for (int c = 0; c < 4; ++c) EXPECT_EQ(plane.at(x, 5)[c], clean.at(x, 5)[c]) << space << x;
    EXPECT_TRUE(std::isnan(plane.at(-1, 5).x));
    EXPECT_FALSE(std::isfinite(plane.at(1, 5).x));
    EXPECT_TRUE(std::isnan(plane.at(3, 5).w)) << "alpha passes through";
    EXPECT_TRUE(std::isfinite(plane.at(3, 5).x));
  }
}

TEST_F(ColorSpaces, TinyAlphaDoesNotOverflow) {
  const auto plane = converted("power", "", {{0.5f, 0.5f, 0.5f, 1e-45f}});
  expect_near(plane.at(-2, 5), {0.25f, 0.25f, 0.25f, 1e-45f});  // 0.5 / 1e-45 is no number: taken as it is
}

TEST_F(ColorSpaces, BorderIsLeftAlone) {
  const auto plane = converted("wide", "", {{1.f, 2.f, 4.f, 1.f}});
  EXPECT_EQ(plane.at(-3, 5).x, 7.f);
  EXPECT_EQ(plane.at(-2, 4).x, 7.f);
  EXPECT_EQ(plane.at(-1, 6).x, 7.f);
}

TEST_F(ColorSpaces, ConfigOfTheEnvironmentServesWhenNoneIsGiven) {
  EXPECT_NE(failure(ExitCode::usage, "", "wide", "").find("--ocio"), std::string::npos);
  setenv("OCIO", config_.c_str(), 1);
  EXPECT_NO_THROW(ColorConversion::between("", "wide", ""));
  setenv("OCIO", "", 1);
  failure(ExitCode::usage, "", "wide", "");
  unsetenv("OCIO");
}

TEST_F(ColorSpaces, UnknownNamesComeWithTheOnesThereAre) {
  const std::string sentence = failure(ExitCode::usage, config_, "Wide gamut", "");
  for (const char* word : {"Wide gamut", "config.ocio", "\"wide\", \"working\"", "\"power\"", "\"lifted\""})
    EXPECT_NE(sentence.find(word), std::string::npos) << sentence << " lacks " << word;
  EXPECT_NE(failure(ExitCode::usage, config_, "wide", "nowhere").find("nowhere"), std::string::npos);
}

TEST_F(ColorSpaces, BrokenConfigsAreInputFailures) {
  EXPECT_NE(failure(ExitCode::input, config_ + ".gone", "wide", "").find(".gone"), std::string::npos);
  failure(ExitCode::input, folder_.string(), "wide", "");
  const std::string broken = (folder_ / "broken.ocio").string();
  std::ofstream(broken) << "ocio_profile_version: 2\nroles: [[[";
  const std::string sentence = failure(ExitCode::input, broken, "wide", "");
  EXPECT_EQ(sentence.find("rror"), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
  EXPECT_NE(failure(ExitCode::input, config_, "lost", "").find("lost.spi1d"), std::string::npos);
}

TEST_F(ColorSpaces, DisplayTakesTheDefaultsOrWhatIsNamed) {
  glm::vec4 row[] = {{0.25f, 0.04f, 1.f, 0.5f}, {kNan, kInf, -kInf, kNan}};
  DisplayTransform::make(config_, "", "", "").apply_row(row, 2);
  expect_near(row[0], {0.5f, 0.2f, 1.f, 0.5f}, 1e-5f);  // over black: no division by alpha
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(row[1][c])) << c;
  EXPECT_EQ(row[1].x, 0.f);
  glm::vec4 raw[] = {{0.25f, 0.04f, 1.f, 0.5f}};
  DisplayTransform::make(config_, "working", "screen", "Raw").apply_row(raw, 1);
  expect_near(raw[0], {0.25f, 0.04f, 1.f, 0.5f});
}

TEST_F(ColorSpaces, UnknownDisplaysAndViewsAreNamed) {
  const auto sentence = [&](const char* display, const char* view) {
    try {
      DisplayTransform::make(config_, "", display, view);
    } catch (const Failure& f) {
      EXPECT_EQ(f.code(), ExitCode::usage);
      return std::string(f.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(sentence("cinema", "").find("\"screen\", \"wall\""), std::string::npos) << sentence("cinema", "");
  EXPECT_NE(sentence("wall", "Plain").find("\"Wide\""), std::string::npos) << sentence("wall", "Plain");
}

}  // namespace
}  // namespace varve
