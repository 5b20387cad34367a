#include "motion/convention.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace varve {
namespace {

constexpr double kWidth = 200, kHeight = 100;

/// The decoder as the header words it, in pixels, y down.
double decode(double v, const MotionEncoding& e, bool y) {
  const double size = y ? kHeight : kWidth;
  const double to_pixels = e.unit == MotionUnit::pixel ? 1 : e.unit == MotionUnit::unit ? size : size / 2;
  return (y ? e.sign_y : e.sign_x) * ((v - e.bias) * e.scale) / e.shutter * to_pixels;
}

TEST(Conventions, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const MotionConvention& row : motion_conventions()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(find_motion_convention(row.name), &row);
    EXPECT_FALSE(row.note.empty()) << row.name;
  }
  EXPECT_EQ(find_motion_convention("auto"), nullptr);
  EXPECT_EQ(find_motion_convention("Cycles"), nullptr);
}

TEST(Conventions, EveryRowIsSound) {
  for (const MotionConvention& row : motion_conventions()) {
    EXPECT_EQ(row.backward_x.empty(), row.backward_y.empty()) << row.name;
    EXPECT_EQ(row.forward_x.empty(), row.forward_y.empty()) << row.name;
    EXPECT_FALSE(row.backward_x.empty() && row.forward_x.empty()) << row.name;
    if (!row.backward_x.empty()) {
      EXPECT_EQ(row.backward.direction, MotionDirection::previous) << row.name;
    }
    if (!row.forward_x.empty()) {
      EXPECT_EQ(row.forward.direction, MotionDirection::next) << row.name;
    }
    EXPECT_GT(row.background_depth, 1e9) << row.name;
    for (const MotionEncoding& e : {row.backward, row.forward}) {
      EXPECT_EQ(std::abs(e.sign_x), 1) << row.name;
      EXPECT_EQ(std::abs(e.sign_y), 1) << row.name;
      EXPECT_GT(e.scale, 0) << row.name;
      EXPECT_EQ(decode(e.bias, e, false), 0) << row.name;  // what the row calls rest is rest
    }
  }
}

// A surface that was at (-6, +8) px from here in the previous frame and will be at (+6, -8) px (y down), as each
// renderer writes it. Written down from the documentation of each row, not from the table.
TEST(Conventions, AKnownMoveIsDecoded) {
  const struct {
    const char* name;
    double backward_x, backward_y, forward_x, forward_y;  // NaN: not stored
  } cases[] = {
      {"cycles", -6, -8, -6, -8},      {"cycles-fileout", -6, -8, NAN, NAN},
      {"nuke", -6, -8, 6, 8},          {"varve", -6, 8, 6, -8},
      {"vray", NAN, NAN, 3.5, 4.5},    {"arnold", NAN, NAN, 6, 8},
      {"rsmb", NAN, NAN, 3.5, 4.5},    {"maya", NAN, NAN, 0.5 + 6 / 512.0, 0.5 + 8 / 512.0},
      {"c4d", NAN, NAN, 3.5, 4.5},     {"renderman", -6, 8, 6, -8},
      {"redshift", NAN, NAN, 6, 8},    {"moonray", NAN, NAN, 0.06, 0.16},
      {"unity", 0.03, 0.08, NAN, NAN}, {"unreal", 0.515, 0.54, NAN, NAN},
      {"fusion", -6, -8, 6, 8},        {"max", NAN, NAN, 6, 8},
  };
  EXPECT_EQ(std::size(cases), motion_conventions().size());
  for (const auto& c : cases) {
    const MotionConvention* row = find_motion_convention(c.name);
    ASSERT_TRUE(row) << c.name;
    EXPECT_EQ(row->backward_x.empty(), std::isnan(c.backward_x)) << c.name;
    EXPECT_EQ(row->forward_x.empty(), std::isnan(c.forward_x)) << c.name;
    if (!std::isnan(c.backward_x)) {
      EXPECT_NEAR(decode(c.backward_x, row->backward, false), -6, 1e-9) << c.name;
      EXPECT_NEAR(decode(c.backward_y, row->backward, true), 8, 1e-9) << c.name;
    }
    if (!std::isnan(c.forward_x)) {
      EXPECT_NEAR(decode(c.forward_x, row->forward, false), 6, 1e-9) << c.name;
      EXPECT_NEAR(decode(c.forward_y, row->forward, true), -8, 1e-9) << c.name;
    }
  }
}

TEST(Conventions, OnlyMeasuredRowsClaimIt) {
  std::set<std::string_view> measured;
  for (const MotionConvention& row : motion_conventions())
    if (row.evidence == Evidence::measured) measured.insert(row.name);
  EXPECT_EQ(measured, (std::set<std::string_view>{"cycles", "cycles-fileout", "nuke", "varve"}));
}

}  // namespace
}  // namespace varve
