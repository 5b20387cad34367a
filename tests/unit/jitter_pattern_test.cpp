// The named patterns: what each promises, and that a list is read back to the last bit.
#include "exr/jitter_pattern.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>

#include "base/json.h"
#include "exr/jitter.h"
#include "exr/jitter_list.h"
#include "support/refusal.h"

namespace varve {
namespace {

using test::message_of;

std::vector<Jitter> points_of(const std::string& name, PatternRequest request = {}) {
  return find_jitter_pattern(name)->points(request);
}

/// A file of its own, gone when the test is over.
struct ListFile {
  explicit ListFile(const std::string& text) {
    path = (std::filesystem::temp_directory_path() / ("varve_list_" + std::to_string(getpid()) + ".csv")).string();
    std::ofstream(path, std::ios::binary) << text;
  }
  ~ListFile() { std::filesystem::remove(path); }
  std::string path;
};

double nearest_pair(const std::vector<Jitter>& points) {
  double nearest = 2;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double dx = std::abs(points[i].x - points[k].x), dy = std::abs(points[i].y - points[k].y);
      nearest = std::min(nearest, std::hypot(std::min(dx, 1 - dx), std::min(dy, 1 - dy)));
    }
  return nearest;
}

TEST(JitterPatterns, EachHasItsLengthStaysInItsPixelAndIsTheSameAgain) {
  std::set<std::string_view> names;
  for (const JitterPattern& pattern : jitter_patterns()) {
    EXPECT_TRUE(names.insert(pattern.name).second) << pattern.name;
    EXPECT_FALSE(pattern.meaning.empty() || pattern.source.empty()) << pattern.name;
    EXPECT_EQ(pattern.length == 0, pattern.most > 0) << pattern.name;
    for (const int length : {1, 2, 7, 16, 61}) {
      PatternRequest request;
      request.length = pattern.length > 0 ? pattern.length : length;
      request.direction = 37;
      const std::vector<Jitter> points = pattern.points(request), again = pattern.points(request);
      ASSERT_EQ(int(points.size()), request.length) << pattern.name;
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_TRUE(points[i].x >= -0.5 && points[i].x < 0.5 && points[i].y >= -0.5 && points[i].y < 0.5)
            << pattern.name << " " << points[i].x << "," << points[i].y;
        EXPECT_TRUE(points[i].x == again[i].x && points[i].y == again[i].y) << pattern.name;
      }
    }
  }
}

TEST(JitterPatterns, CentroidsAreTheKnownOnes) {
  const struct {
    const char* name;
    int length;
    double x, y;
  } cases[] = {{"halton23", 4, -0.094, -0.111},
               {"halton23", 8, -0.055, 0.000},
               {"halton23", 16, -0.029, -0.037},
               {"halton23", 32, -0.015, -0.019},
               {"hammersley", 4, -0.125, -0.125},
               {"uniform4", 4, 0, 0},
               {"rotated4", 4, 0, 0},
               {"msaa4", 4, 0, 0},
               {"two-frame", 2, 0, 0}};
  for (const auto& c : cases) {
    PatternRequest request;
    request.length = c.length;
    const Jitter centroid = centroid_of(points_of(c.name, request));
    EXPECT_NEAR(centroid.x, c.x, 6e-4) << c.name << c.length;
    EXPECT_NEAR(centroid.y, c.y, 6e-4) << c.name << c.length;
  }
}

TEST(JitterPatterns, OrdersOfOneSetAreThatSet) {
  const auto sorted = [](std::vector<Jitter> p) {
    std::ranges::sort(p, {}, [](const Jitter& j) { return std::pair(j.x, j.y); });
    return p;
  };
  for (const auto& [a, b] : {std::pair("uniform4", "helix4"), std::pair("rotated4", "rotated4-helix")}) {
    const std::vector<Jitter> first = sorted(points_of(a)), second = sorted(points_of(b));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(first[i].x == second[i].x && first[i].y == second[i].y) << a;
  }
  const std::vector<Jitter> helix = points_of("helix4"), twice = points_of("double-helix");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(helix[i].x == twice[i].x && helix[i].y == twice[i].y);
  // A helix crosses the middle row with every frame, round the corner too.
  for (const char* name : {"helix4", "rotated4-helix"}) {
    const std::vector<Jitter> p = points_of(name);
    EXPECT_LT(p[0].y * p[1].y, 0) << name;
    EXPECT_LT(p[2].y * p[3].y, 0) << name;
  }
}

TEST(JitterPatterns, GridsShareNoRowOrColumn) {
  for (const char* name : {"rotated4", "rotated4-helix", "msaa2", "msaa4", "msaa8", "msaa16"}) {
    std::set<double> columns, rows;
    const std::vector<Jitter> points = points_of(name);
    for (const Jitter& p : points) columns.insert(p.x), rows.insert(p.y);
    EXPECT_EQ(columns.size(), points.size()) << name;
    EXPECT_EQ(rows.size(), points.size()) << name;
    for (const Jitter& p : points) EXPECT_EQ(p.x * 16, std::floor(p.x * 16)) << name;  // sixteenths of a pixel
  }
}

TEST(JitterPatterns, ChanceFollowsItsSeedAndKeepsItsPromise) {
  for (const char* name : {"poisson", "stratified", "random"}) {
    const std::vector<Jitter> a = points_of(name, {64, 1, 0}), b = points_of(name, {64, 2, 0});
    EXPECT_NE(a[0].x, b[0].x) << name;
  }
  // One in each cell of the 8x8 grid.
  std::set<int> cells;
  for (const Jitter& p : points_of("stratified", {64, 5, 0}))
    cells.insert(int((p.x + 0.5) * 8) + 8 * int((p.y + 0.5) * 8));
  EXPECT_EQ(cells.size(), 64u);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    EXPECT_GT(nearest_pair(points_of("poisson", {64, seed, 0})), 0.06) << seed;  // a hexagonal grid has 0.134
    EXPECT_LT(nearest_pair(points_of("random", {64, seed, 0})), 0.04) << seed;
  }
}

TEST(JitterPatterns, MotionPerpendicularIsThat) {
  for (const double degrees : {0.0, 30.0, 90.0, -135.0, 360.0}) {
    const std::vector<Jitter> p = points_of("motion-perpendicular", {2, 0, degrees});
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(p[0].x * std::cos(angle) + p[0].y * std::sin(angle), 0, 1e-15);
    EXPECT_NEAR(std::hypot(p[0].x, p[0].y), 0.25, 1e-15);
    EXPECT_EQ(p[0].x, -p[1].x);
    EXPECT_EQ(p[0].y, -p[1].y);
  }
}

TEST(JitterPatterns, LengthsThatCannotBeAreRefused) {
  for (const char* text : {"uniform4:5", "uniform4:", "halton23:0", "halton23:1048577", "poisson:4097", "msaa8:x"})
    message_of([&] { parse_pattern(text); }, ExitCode::usage);
  EXPECT_FALSE(parse_pattern("sobol:16"));
  EXPECT_EQ(parse_pattern("uniform4:4")->length, 4);
  EXPECT_EQ(parse_pattern("r2")->length, 0);
  EXPECT_EQ(parse_jitter_source("r2").points.size(), 16u);
  JitterListJob job;
  job.pattern = "poisson";
  job.count = 5000;
  EXPECT_NE(message_of([&] { list_jitter(job); }, ExitCode::usage).find("poisson:64"), std::string::npos);
  job.pattern = "sobol";
  EXPECT_NE(message_of([&] { list_jitter(job); }, ExitCode::usage).find("halton23, hammersley"), std::string::npos);
}

TEST(JitterList, IsReadBackToTheLastBitAndIsWhatThePatternGives) {
  for (const JitterPattern& pattern : jitter_patterns())
    for (const bool centered : {false, true}) {
      JitterListJob job;
      job.pattern = pattern.name;
      job.count = 23;
      job.first = -4;
      job.centered = centered;
      if (pattern.length == 0) job.pattern += ":7";
      const JitterList list = list_jitter(job);
      const ListFile file(jitter_csv(job, list));
      const JitterSource read = parse_jitter_source(file.path), named = parse_jitter_source(job.pattern);
      ASSERT_EQ(read.table.size(), 23u) << pattern.name;
      for (const auto& [frame, jitter] : read.table) {
        const Jitter expected = *jitter_of(named, {}, frame);
        EXPECT_EQ(jitter.x, expected.x - (centered ? list.centroid.x : 0)) << pattern.name << " frame " << frame;
        EXPECT_EQ(jitter.y, expected.y - (centered ? list.centroid.y : 0)) << pattern.name << " frame " << frame;
      }
      if (!centered) continue;
      EXPECT_NEAR(centroid_of(list.points).x, 0, 1e-15);
      EXPECT_NEAR(centroid_of(list.points).y, 0, 1e-15);
    }
}

TEST(JitterList, AmplitudeShrinksThePatternAboutTheCenter) {
  JitterListJob job;
  job.pattern = "halton23";
  const JitterList whole = list_jitter(job);
  job.amplitude = 0.5;
  const JitterList half = list_jitter(job);
  for (std::size_t i = 0; i < whole.points.size(); ++i) EXPECT_EQ(half.points[i].x, whole.points[i].x / 2);
  EXPECT_EQ(half.centroid.y, whole.centroid.y / 2);
  EXPECT_NE(jitter_csv(job, half).find("# amplitude 0.5\n"), std::string::npos);
  job.amplitude = 0;
  for (const Jitter& p : list_jitter(job).points) EXPECT_TRUE(p.x == 0 && p.y == 0);
}

TEST(JitterList, JsonSaysTheSame) {
  JitterListJob job;
  job.pattern = "halton23";
  job.count = 5;
  const JitterList list = list_jitter(job);
  const std::optional<JsonValue> json = parse_json(jitter_json(job, list));
  ASSERT_TRUE(json);
  ASSERT_EQ(json->find("frames")->items.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(json->find("frames")->items[std::size_t(i)].find("jx")->number, list.points[std::size_t(i)].x);
    EXPECT_EQ(json->find("frames")->items[std::size_t(i)].find("jy")->number, list.points[std::size_t(i)].y);
  }
  EXPECT_EQ(json->find("centroid")->numbers()->at(1), list.centroid.y);
}

TEST(JitterConventions, AProjectionWithTheTranslationSeesTheSampleAtThePixelCenter) {
  const double width = 320, height = 180;
  const auto conventions = jitter_conventions();
  const auto ndc = std::ranges::find(conventions, "ndc", &JitterConvention::name);
  for (const Jitter jitter : {Jitter{0.5, -0.5}, Jitter{-0.3, 0.2}, Jitter{0, 0.5}}) {
    // A point of the scene that lies at the sample of pixel (200, 40), through an OpenGL matrix.
    const double sx = (200.5 + jitter.x) / width * 2 - 1, sy = 1 - (40.5 + jitter.y) / height * 2, z = -7;
    const double p00 = 1.3, p11 = 1.3 * width / height;
    const double x = sx * -z / p00, y = sy * -z / p11;
    const Jitter t = ndc->convert(jitter, width, height);
    const double p02 = -t.x, p12 = -t.y;  // "subtract them from [0][2] and [1][2]"
    const double nx = (p00 * x + p02 * z) / -z, ny = (p11 * y + p12 * z) / -z;
    EXPECT_NEAR((nx + 1) / 2 * width, 200.5, 1e-9);
    EXPECT_NEAR((1 - ny) / 2 * height, 40.5, 1e-9);
  }
  // The trap of half the range: half a pixel is 1 / width, not half of that.
  EXPECT_DOUBLE_EQ(std::abs(ndc->convert({0.5, 0.5}, width, height).x), 1 / width);
  EXPECT_DOUBLE_EQ(std::abs(ndc->convert({0.5, 0.5}, width, height).y), 1 / height);
}

TEST(JitterConventions, WindowsMoveWithTheSample) {
  // Camera windows are y up and move towards the sample; a whole picture width is 1 of shift or 2 of window.
  for (const JitterConvention& row : jitter_conventions()) {
    if (row.name == "pixels" || row.name == "ndc") continue;
    const Jitter right = row.convert({0.25, 0}, 200, 100), down = row.convert({0, 0.25}, 200, 100);
    EXPECT_GT(right.x, 0) << row.name;
    EXPECT_LT(down.y, 0) << row.name;
    EXPECT_EQ(right.y, 0) << row.name;
    EXPECT_TRUE(row.needs_size);
  }
  JitterListJob job;
  job.pattern = "helix4";
  job.convention = "cycles";
  EXPECT_NE(message_of([&] { list_jitter(job); }, ExitCode::usage).find("--size"), std::string::npos);
  job.width = 1920, job.height = 1080;
  const ListFile file(jitter_csv(job, list_jitter(job)));
  message_of([&] { parse_jitter_source(file.path); }, ExitCode::input);  // not mistaken for pixels
}

}  // namespace
}  // namespace varve
