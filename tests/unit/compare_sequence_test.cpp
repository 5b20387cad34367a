// The whole comparison against figures that were measured by other means, and its verdicts.
#include "compare_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "paths.h"
#include "stages/comparison_text.h"
#include "stages/page_pictures.h"
#include "stages/page_plot.h"

namespace varve {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CompareSequence, ReachesTheKnownFiguresOfTheCourtyard) {
  const std::string folder = std::string(VARVE_DATA) + "/courtyard/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the development data is not here";
  CompareJob job;
  job.a = SequencePattern::parse(folder + "ref/frame.####.exr");
  job.b = SequencePattern::parse(folder + "jit/frame.####.exr");
  job.frames = {9, 10, 11, 12, 13, 14, 15, 16};
  job.metrics = MetricSet();
  for (MetricId id : {MetricId::psnr, MetricId::warped, MetricId::ghost, MetricId::bias, MetricId::flicker})
    job.metrics.set(std::size_t(id));
  const Comparison c = compare_sequence(job, {});
  ASSERT_FALSE(c.rows.empty());
  const MetricValues& v = c.rows.front().sequence;
  EXPECT_EQ(c.verdict, Verdict::beyond);
  EXPECT_NEAR(v[MetricId::psnr], 23.71, 0.005);
  EXPECT_NEAR(v[MetricId::ghost], 0, 0.02);  // raw frames hold nothing of the frame before
  EXPECT_GT(v[MetricId::warped], 0);         // vectors were found in B
  EXPECT_NEAR(v[MetricId::bias] + v[MetricId::flicker], std::pow(0.1779, 2), 1e-4);
  job.metrics = MetricSet().set(std::size_t(MetricId::psnr_tone));
  EXPECT_NEAR(compare_sequence(job, {}).rows.front().sequence[MetricId::psnr_tone], 29.29, 0.005);
}

/// One color over frames 1 and 2.
Comparison comparison(double first, double second, double differing = 1) {
  Comparison c;
  c.frames = {1, 2};
  c.rows.push_back({"main", true, std::vector<MetricValues>(2), {}});
  c.rows[0].frames[0][MetricId::psnr] = first;
  c.rows[0].frames[1][MetricId::psnr] = second;
  for (MetricValues* v : {&c.rows[0].frames[0], &c.rows[0].frames[1], &c.rows[0].sequence}) {
    (*v)[MetricId::differing] = differing;
    (*v)[MetricId::not_finite] = 0;
  }
  return c;
}

Verdict judged(Comparison c, const std::vector<Limit>& limits) {
  judge(c, limits);
  return c.verdict;
}

TEST(Judge, NanHoldsNoLimit) {
  const std::vector<Limit> limits = {{MetricId::psnr, 30, true}};
  EXPECT_EQ(judged(comparison(31, 32), limits), Verdict::within);
  EXPECT_EQ(judged(comparison(31, 29), limits), Verdict::beyond);
  EXPECT_EQ(judged(comparison(31, kNan), limits), Verdict::beyond);
  EXPECT_EQ(judged(comparison(31, 32), {}), Verdict::beyond);
  EXPECT_EQ(judged(comparison(31, 29), {{MetricId::psnr, 30, false}, {MetricId::psnr, 20, true}}), Verdict::within);
  EXPECT_EQ(judged(comparison(31, 32, 0), {}), Verdict::equal);
  EXPECT_EQ(judged(comparison(31, 32, kNan), {}), Verdict::beyond);
}

TEST(Judge, ShapeIsBeyondEveryLimitAndAFormatOnlyUnequal) {
  const std::vector<Limit> limits = {{MetricId::psnr, 30, true}};
  Comparison c = comparison(31, 32, 0);
  c.findings = {{1, 1, {"a note", FindingKind::note}}};
  EXPECT_EQ(judged(c, {}), Verdict::equal);
  c.findings = {{1, 1, {"half against float", FindingKind::format}}};
  EXPECT_EQ(judged(c, {}), Verdict::beyond);
  EXPECT_EQ(judged(c, limits), Verdict::within);
  c.findings = {{1, 1, {"a channel lacks", FindingKind::shape}}};
  EXPECT_EQ(judged(c, limits), Verdict::beyond);
}

TEST(Judge, TheWorstFrameIsNamed) {
  Comparison c = comparison(29, 25);
  judge(c, {{MetricId::psnr, 30, true}});
  ASSERT_EQ(c.broken.size(), 1u);
  EXPECT_EQ(c.broken[0].frame, 2);
  EXPECT_EQ(c.broken[0].value, 25);
  EXPECT_NE(comparison_text(c).find("psnr of main in frame 2 is 25.00"), std::string::npos);
}

TEST(ComparisonText, StaysWithinAHundredColumns) {
  Comparison c = comparison(29, 25, 1234567);
  for (const Metric& metric : metrics())
    c.rows[0].frames[0][metric.id] = c.rows[0].sequence[metric.id] = -0.000123456789;
  judge(c, {});
  const std::string text = comparison_text(c);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    EXPECT_LE(end - at, 100u) << text.substr(at, end - at);
    at = end + 1;
  }
}

TEST(Base64, KnownValues) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(PagePlot, GapsAreGaps) {
  EXPECT_EQ(page_plot({1, 2}, {kNan, kNan}, {}), "");
  const std::string plot = page_plot({1, 2, 3, 4, 5}, {1, 2, kNan, INFINITY, 3}, 2.5);
  EXPECT_EQ(plot.find("nan"), std::string::npos);
  EXPECT_EQ(plot.find("inf"), std::string::npos);
  const std::size_t first = plot.find("<polyline");
  EXPECT_NE(plot.find("<polyline", first + 1), std::string::npos);
  EXPECT_NE(page_plot({7}, {5}, {}).find("<circle"), std::string::npos);
}

}  // namespace
}  // namespace varve
