#include "exr/pictures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "base/error.h"
#include "diagnose/aov.h"
#include "support/png.h"

namespace varve {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
using Color = std::array<int, 3>;

Color color_at(const test::Png& png, int x, int y) {
  const std::uint8_t* p = png.pixel(x, y);
  return {p[0], p[1], p[2]};
}

class Pictures : public ::testing::Test {
 protected:
  void SetUp() override {
#ifndef VARVE_HAS_PICTURES
    GTEST_SKIP() << "built without VARVE_PICTURES";
#endif
    folder_ = std::filesystem::temp_directory_path() / ("varve_pictures_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return std::size_t(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }
  std::filesystem::path folder_;
};

Plane<float> row_of(std::initializer_list<float> values, int x0 = 0, int y0 = 0) {
  Plane<float> plane(Window{x0, y0, x0 + int(values.size()), y0 + 1}, 2, 1e30f);
  std::copy(values.begin(), values.end(), plane.row(y0));
  return plane;
}

TEST_F(Pictures, EndsOfTheRangeTakeTheEndsOfTheMap) {
  write_map_png(file("map.png"), row_of({-16.f, 16.f, -1e30f, 1e30f, -kInf, kInf, kNan}, -5, 7), "viridis", -16, 16);
  const test::Png png = test::read_png(file("map.png"));
  EXPECT_EQ(png.width, 7);
  EXPECT_EQ(png.height, 1);
  const Color low{68, 1, 84}, high{253, 231, 37};  // the published first and last entry of viridis
  for (int x : {0, 2, 4, 6}) EXPECT_EQ(color_at(png, x, 0), low) << x;
  for (int x : {1, 3, 5}) EXPECT_EQ(color_at(png, x, 0), high) << x;
  EXPECT_EQ(files(), 1u) << "a temporary file stayed";
}

TEST_F(Pictures, EveryMapOfTheDiagnosticTableIsKnownAndTellsItsEndsApart) {
  for (const Aov& aov : diagnostic_aovs()) {
    const auto low = float(aov.preview_low), high = float(aov.preview_high);
    write_map_png(file("aov.png"), row_of({low, high}), std::string(aov.colormap), aov.preview_low, aov.preview_high);
    const test::Png png = test::read_png(file("aov.png"));
    EXPECT_NE(color_at(png, 0, 0), color_at(png, 1, 0)) << aov.name;
  }
}

TEST_F(Pictures, UnknownMapIsRefusedAndLeavesNothing) {
  try {
    write_map_png(file("map.png"), row_of({0.f}), "no such map", 0, 1);
    FAIL() << "accepted";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::output);
    EXPECT_NE(std::string(failure.what()).find("map.png"), std::string::npos) << failure.what();
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(Pictures, MissingFolderIsNamed) {
  const std::string path = file("nowhere") + "/map.png";
  try {
    write_map_png(path, row_of({0.f}), "viridis", 0, 1);
    FAIL() << "accepted";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::output);
    EXPECT_NE(std::string(failure.what()).find(path), std::string::npos) << failure.what();
  }
}

TEST_F(Pictures, FailureKeepsThePictureThatWasThere) {
  write_map_png(file("map.png"), row_of({0.f, 1.f}), "inferno", 0, 1);
  const test::Png before = test::read_png(file("map.png"));
  EXPECT_THROW(write_map_png(file("map.png"), row_of({0.f}), "no such map", 0, 1), Failure);
  EXPECT_EQ(test::read_png(file("map.png")).rgb, before.rgb);
}

TEST_F(Pictures, ColorsAreEncodedAsSrgb) {
  Plane<glm::vec4> color(Window{3, 2, 8, 4}, 1, glm::vec4(0.f));
  const float values[] = {0.f, 0.18f, 0.5f, 1.f, 400.f};
  for (int x = 3; x < 8; ++x) color.at(x, 2) = glm::vec4(values[x - 3], values[x - 3], values[x - 3], 0.25f);
  color.at(3, 3) = glm::vec4(kNan, kInf, -kInf, 1.f);
  write_color_png(file("color.png"), color, nullptr);
  const test::Png png = test::read_png(file("color.png"));
  ASSERT_EQ(png.width, 5);
  ASSERT_EQ(png.height, 2);
  // 0.18 -> 0.4614, 0.5 -> 0.7354 by IEC 61966-2-1; alpha has no say.
  const int expected[] = {0, 118, 188, 255, 255};
  for (int x = 0; x < 5; ++x) EXPECT_EQ(color_at(png, x, 0), (Color{expected[x], expected[x], expected[x]})) << x;
  EXPECT_EQ(color_at(png, 0, 1), (Color{0, 255, 0}));
}

TEST_F(Pictures, SameInputSameBytesAndNoDate) {
  const Plane<float> plane = row_of({0.f, 0.3f, 0.9f});
  write_map_png(file("a.png"), plane, "turbo", 0, 1);
  const test::Png png = test::read_png(file("a.png"));
  for (const std::string& chunk : png.chunks) {
    EXPECT_NE(chunk, "tIME");
    EXPECT_NE(chunk, "tEXt");
  }
}

TEST_F(Pictures, EmptyPlaneIsRefused) {
  EXPECT_THROW(write_map_png(file("map.png"), Plane<float>(), "viridis", 0, 1), Failure);
  EXPECT_THROW(write_color_png(file("color.png"), Plane<glm::vec4>(), nullptr), Failure);
}

}  // namespace
}  // namespace varve
