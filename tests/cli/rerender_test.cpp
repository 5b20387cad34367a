// varve resolve --aov evaluation and --rerender as a user meets them.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/json.h"
#include "scene_cli.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

class RerenderCli : public SceneCli {
 protected:
  Outcome resolve(const std::string& to, const Arguments& more) const {
    return resolve_into("in/crossing.####.exr", to, more, {});
  }
  JsonValue list(const std::string& name) const {
    const std::optional<JsonValue> value = parse_json(bytes_of(folder / name));
    EXPECT_TRUE(value);
    return value.value_or(JsonValue{});
  }
};

TEST_F(RerenderCli, ThePlaneTellsWhatIsLacking) {
  synth("crossing", "1-3");
  for (const char* accumulator : {"recursive", "two-sided", "gather"}) {
    ASSERT_EQ(resolve("out", {"--accumulator", accumulator, "--aov", "evaluation,count"}).code, 0);
    for (int x = 0; x < 64; x += 7) {
      const float lacks = pixel_of(path("out", 3), "varve.evaluation", x, 17);
      const float has = pixel_of(path("out", 3), "varve.count", x, 17);
      EXPECT_TRUE(std::abs(lacks - std::max(0.0f, 16 - has)) < 1e-3f || lacks == 16) << accumulator << x;
    }
  }
  // The first frame has nothing but itself.
  ASSERT_EQ(resolve("out", {"--aov", "evaluation", "--want-samples", "5"}).code, 0);
  EXPECT_EQ(pixel_of(path("out", 1), "varve.evaluation", 20, 20), 5);
  // Nothing is wanted, nothing is lacking.
  ASSERT_EQ(resolve("out", {"--aov", "evaluation", "--want-samples", "0"}).code, 0);
  EXPECT_EQ(pixel_of(path("out", 1), "varve.evaluation", 20, 20), 0);
}

TEST_F(RerenderCli, TheListIsTheSameForAnyThreadsAndHoldsItsBudget) {
  synth("crossing", "1-4", {"--noise", "0.3"});
  const Arguments line = {"--accumulator",     "gather", "--reach",    "2",      "-f",         "2-3",  "--tile", "8",
                          "--rerender-budget", "1.5",    "--rerender", "a.json", "--rerender", "a.csv"};
  ASSERT_EQ(resolve("out", line).code, 0);
  const std::string json = bytes_of(folder / "a.json"), csv = bytes_of(folder / "a.csv");
  Arguments again = line;
  again.insert(again.end(), {"-j", "3"});
  ASSERT_EQ(resolve("out", again).code, 0);
  EXPECT_EQ(json, bytes_of(folder / "a.json"));
  EXPECT_EQ(csv, bytes_of(folder / "a.csv"));

  const JsonValue all = list("a.json");
  EXPECT_EQ(all.find("width")->number, 64);
  EXPECT_EQ(all.find("frames")->number, 2);
  EXPECT_LE(all.find("samples_per_pixel")->number, 1.5);
  EXPECT_GT(all.find("samples_per_pixel")->number, 0.5);
  EXPECT_GT(all.find("gain")->number, 0);
  double samples = 0;
  std::size_t files = 0;
  for (const JsonValue& render : all.find("renders")->items) {
    const std::vector<double> w = render.find("window")->numbers().value();
    const JsonValue &border = *render.find("border"), &region = *render.find("region");
    EXPECT_NEAR(border.find("min_x")->number * 64, w[0], 1e-9);
    EXPECT_NEAR(border.find("max_x")->number * 64, w[2], 1e-9);
    EXPECT_NEAR((1 - border.find("max_y")->number) * 36, w[1], 1e-9);
    EXPECT_NEAR((1 - border.find("min_y")->number) * 36, w[3], 1e-9);
    EXPECT_EQ(region.find("max_x")->number, w[2] - 1);
    EXPECT_EQ(region.find("min_y")->number, w[1]);
    const std::size_t count = render.find("jitter")->items.size();
    EXPECT_EQ(count, std::size_t(render.find("samples")->number));
    EXPECT_EQ(count, render.find("files")->items.size());
    samples += (w[2] - w[0]) * (w[3] - w[1]) * double(count);
    files += count;
  }
  EXPECT_EQ(samples, all.find("samples")->number);
  EXPECT_EQ(std::size_t(std::count(csv.begin(), csv.end(), '\n')), files + 1);
}

TEST_F(RerenderCli, OddRequestsAreRefused) {
  synth("crossing", "1-2");
  EXPECT_EQ(resolve("out", {"--rerender", "list.txt"}).code, 2);
  EXPECT_EQ(resolve("out", {"--rerender", "list.json", "--resume"}).code, 2);
  EXPECT_EQ(resolve("out", {"--rerender", "nowhere/list.json"}).code, 5);
  EXPECT_EQ(resolve("out", {"--rerender", "in/crossing.0001.exr.json", "--tile", "2"}).code, 2);
}

}  // namespace
}  // namespace varve::test
