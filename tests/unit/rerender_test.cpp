// What pixels lack, and the list that comes of it: against the slow twin, and the laws.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "base/json.h"
#include "reference/evaluation_reference.h"
#include "rerender/rerender_list.h"
#include "samples/add_samples.h"
#include "samples/resolve_samples.h"
#include "support/scenes.h"

namespace varve {
namespace {

using test::EvaluatedPixel;

struct Pair {
  Present present;
  Accumulated resolved;
};

/// A frame after two others, so that some pixels have a history and some do not.
Pair make_pair(const Window& w, float scale, bool with_variance, Workers& workers) {
  RecursiveParameters recursive;
  RectifyParameters rectify;
  Pair pair;
  History history;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    pair.present =
        test::noise_present(w, {.seed = seed, .bad_share = 0.05, .bad_motion = 0.1, .scale = scale}, workers);
    pair.resolved =
        accumulate(pair.present, history, recursive, rectify, {}, kRejectFirstFrame, {.reject = true}, workers);
    history = {};
    history.color = pair.resolved.history.color.clone(), history.total = pair.resolved.history.total.clone();
    history.spread = pair.resolved.history.spread.clone(), history.rows_valid = pair.resolved.history.rows_valid;
  }
  if (with_variance) {
    pair.resolved.diagnostics.variance = Plane<float>(w);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x)
        pair.resolved.diagnostics.variance.at(x, y) = 0.01f * scale * scale * float((x * 7 + y * 3 + 100) % 11);
  }
  return pair;
}

TEST(Evaluation, IsThatOfTheSlowTwin) {
  Workers workers(2);
  for (const Window& w : {Window{0, 0, 1, 1}, Window{-3, 2, 14, 15}, Window{5, 5, 6, 20}})
    for (const bool variance : {false, true})
      for (const RerenderRequest& request : {RerenderRequest{.want_samples = 16, .files = {}},
                                             RerenderRequest{.want_samples = 4, .want_noise = 0.05, .files = {}},
                                             RerenderRequest{.want_samples = 0, .want_noise = 0.2, .files = {}}}) {
        const Pair p = make_pair(w, 1, variance, workers);
        const Evaluation e = evaluate(p.present, p.resolved, request, workers);
        for (int y = w.y0; y < w.y1; ++y)
          for (int x = w.x0; x < w.x1; ++x) {
            const EvaluatedPixel slow = test::evaluate_pixel(p.present, p.resolved, request, x, y);
            EXPECT_NEAR(double(e.lacking.at(x, y)), slow.lacking, 1e-5 * (1 + slow.lacking));
            EXPECT_NEAR(double(e.count.at(x, y)), slow.count, 1e-5 * (1 + slow.count));
            EXPECT_NEAR(double(e.variance.at(x, y)), slow.variance, 1e-5 * (1e-3 + slow.variance));
            EXPECT_EQ(e.failed.at(x, y) != 0, slow.failed);
          }
      }
}

TEST(Evaluation, DoesNotDependOnTheScaleOrOnThreads) {
  Workers one(1), three(3);
  const Window w{0, 0, 19, 11};
  const RerenderRequest request{.want_samples = 8, .want_noise = 0.1, .files = {}};
  const Pair p = make_pair(w, 1, true, one);
  const Evaluation e = evaluate(p.present, p.resolved, request, one);
  for (const float scale : {0.0009765625f, 1024.0f}) {
    const Pair q = make_pair(w, scale, true, one);
    const Evaluation f = evaluate(q.present, q.resolved, request, three);
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 19; ++x) EXPECT_EQ(e.lacking.at(x, y), f.lacking.at(x, y)) << scale;
  }
}

TEST(Evaluation, StaysFiniteAtTheExtremes) {
  Workers workers(1);
  const Window w{0, 0, 7, 5};
  for (const float value : {0.0f, 65504.0f, 1e30f, -1e30f, 1e-40f, std::numeric_limits<float>::max()}) {
    Pair p = make_pair(w, 1, true, workers);
    p.present.color.fill(glm::vec4(value));
    p.present.color.at(3, 2) = glm::vec4(-value);
    p.resolved.history.color.fill(glm::vec4(value));
    p.resolved.diagnostics.variance.fill(std::numeric_limits<float>::max());
    const Evaluation e =
        evaluate(p.present, p.resolved, {.want_samples = 16, .want_noise = 1e-3, .files = {}}, workers);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) {
        EXPECT_TRUE(e.lacking.at(x, y) >= 0 && e.lacking.at(x, y) <= float(kMostLacking)) << value;
        EXPECT_TRUE(e.variance.at(x, y) >= 0 && e.variance.at(x, y) <= 1) << value;
      }
  }
}

/// Noise in a corner of each frame, moving.
std::vector<TileFrame> make_tiles(const RerenderRequest& request, int frames) {
  std::vector<TileFrame> all;
  for (int f = 0; f < frames; ++f) {
    const Window w{-3, 2, 75, 51};
    Evaluation e{Plane<float>(w, 0, 0.0f), Plane<float>(w, 0, 4.0f), Plane<float>(w, 0, 1e-4f),
                 Plane<std::uint8_t>(w, 0, std::uint8_t(0))};
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const double d = std::hypot(x - 10 - 5 * f, y - 20);
        if (d > 18) continue;
        e.lacking.at(x, y) = 64, e.count.at(x, y) = 1, e.variance.at(x, y) = float(0.02 / (1 + d));
        e.failed.at(x, y) = d < 6;
      }
    all.push_back(sum_tiles(10 + f, e, request));
  }
  return all;
}

TEST(RerenderList, RectanglesCoverEveryTileOnceWithItsSamples) {
  for (const int overhead : {0, 100, 100000}) {
    RerenderRequest request{.tile = 8, .overhead = overhead, .files = {}};
    std::vector<TileFrame> frames = make_tiles(request, 3);
    spend(frames, 6000);
    for (const TileFrame& frame : frames) {
      const std::vector<RenderRectangle> rectangles = merge_tiles(frame, overhead);
      for (const Tile& tile : frame.tiles) {
        int covered = 0, samples = 0;
        for (const RenderRectangle& r : rectangles) {
          const Window both = intersect(r.window, tile.window);
          if (both.empty()) continue;
          EXPECT_EQ(both, tile.window);
          ++covered, samples = r.samples;
        }
        EXPECT_LE(covered, 1);
        EXPECT_GE(samples, samples_of_step(tile.step));
        if (overhead == 0) {
          EXPECT_EQ(samples, samples_of_step(tile.step));
        }
      }
    }
  }
}

TEST(RerenderList, HoldsItsBudgetAndTakesTheBestTilesFirst) {
  double last_gain = 0;
  for (const double budget : {0.05, 0.5, 2.0, 8.0}) {
    const RerenderRequest request{.tile = 8, .budget = budget, .files = {}};
    const RerenderList list = make_rerender_list(make_tiles(request, 3), {0, 0, 72, 50}, request, {});
    EXPECT_LE(list.samples, budget * double(list.pixels));
    EXPECT_GE(list.gain, last_gain);
    last_gain = list.gain;
  }
  EXPECT_GT(last_gain, 0);
  // Where little may be spent, it goes to where reconstruction failed.
  const RerenderRequest small{.tile = 8, .budget = 0.02, .overhead = 0, .files = {}};
  for (const RerenderEntry& e : make_rerender_list(make_tiles(small, 3), {0, 0, 72, 50}, small, {}).entries)
    EXPECT_GT(e.what.failed, 0u);
}

TEST(RerenderList, MergingSavesRendersForWhatTheyCost) {
  RerenderRequest request{.tile = 8, .budget = 1, .overhead = 0, .files = {}};
  const std::size_t apart = make_rerender_list(make_tiles(request, 2), {0, 0, 72, 50}, request, {}).entries.size();
  request.overhead = 2000;
  EXPECT_LT(make_rerender_list(make_tiles(request, 2), {0, 0, 72, 50}, request, {}).entries.size(), apart);
}

TEST(RerenderList, PositionsFillWhatIsFree) {
  FramePositions known;
  known[4] = {{-0.25, -0.25}, {0.25, 0.25}};
  known[5] = {{0.25, -0.25}};
  const FramePositions found = fill_positions({{4, 1}, {5, 9}, {400, 2}}, known);
  EXPECT_EQ(found.at(5).size(), 9u);
  // The place that is free in frame 4, as far as 1024 points tell.
  EXPECT_NEAR(found.at(4)[0].x, -0.25, 0.06);
  EXPECT_NEAR(found.at(4)[0].y, 0.25, 0.06);
  std::vector<glm::dvec2> all = found.at(5);
  all.push_back({0.25, -0.25});
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec2 d = all[i] - all[j];
      EXPECT_GT(std::hypot(d.x - std::round(d.x), d.y - std::round(d.y)), 0.1);
      EXPECT_LE(std::fmax(std::fabs(all[i].x), std::fabs(all[i].y)), 0.5);
    }
}

TEST(RerenderList, IsJsonAndCsvOfTheSameRenders) {
  const RerenderRequest request{.tile = 8, .budget = 0.5, .files = {}};
  const RerenderList list = make_rerender_list(make_tiles(request, 2), {0, 0, 72, 50}, request, {});
  const std::optional<JsonValue> json = parse_json(rerender_json(list, "1.2.3"));
  ASSERT_TRUE(json);
  EXPECT_EQ(json->find("schema")->number, 1);
  EXPECT_EQ(json->find("renders")->items.size(), list.entries.size());
  std::size_t samples = 0;
  for (const RerenderEntry& e : list.entries) samples += e.files.size();
  const std::string csv = rerender_csv(list);
  EXPECT_EQ(std::size_t(std::count(csv.begin(), csv.end(), '\n')), samples + 1);
  const RerenderList none = make_rerender_list({}, {}, request, {});
  EXPECT_TRUE(parse_json(rerender_json(none, "1")));
}

/// `first` with samples of its own in a window.
Present crop_of(const Present& first, const Window& crop, unsigned seed, Workers& workers) {
  Present p = test::noise_present(first.color.window(), {.seed = seed, .with_depth = true}, workers);
  const Window& w = first.color.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (!crop.contains(x, y)) {
        p.valid.at(x, y) = 0, p.color.at(x, y) = first.color.at(x, y);
        p.motion.at(x, y) = first.motion.at(x, y), p.depth.at(x, y) = first.depth.at(x, y);
      }
  p.jitter = glm::dvec2(0.3, -0.2);
  return p;
}

TEST(AddSamples, LeavesTheOthersAsTheyWereBitForBit) {
  Workers workers(2);
  const Window w{-3, 2, 40, 31}, crop{4, 8, 12, 15};
  for (const SampleFilter filter : {SampleFilter::none, SampleFilter::gaussian, SampleFilter::mitchell}) {
    const auto make = [&] {
      Present p = test::noise_present(w, {.seed = 1, .bad_share = 0.05, .with_depth = true}, workers);
      p.jitter = glm::dvec2(-0.1, 0.4);
      return p;
    };
    const Present first = make();
    std::vector<Present> further;
    further.push_back(crop_of(first, crop, 7, workers));
    further.push_back(crop_of(first, crop, 8, workers));
    const Present out = add_samples(make(), further, filter, workers);
    RecursiveParameters recursive;
    recursive.sample_filter = filter;
    const Accumulated plain = accumulate(first, {}, recursive, {}, first.jitter, kRejectFirstFrame, {}, workers);
    const Accumulated with = accumulate(out, {}, recursive, {}, out.jitter, kRejectFirstFrame, {}, workers);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        const bool beyond = x < crop.x0 - 3 || x >= crop.x1 + 3 || y < crop.y0 - 3 || y >= crop.y1 + 3;
        if (beyond) {
          EXPECT_EQ(with.history.color.at(x, y), plain.history.color.at(x, y));
          EXPECT_EQ(with.history.total.at(x, y), plain.history.total.at(x, y));
          EXPECT_EQ(out.color.at(x, y), first.color.at(x, y));
          EXPECT_EQ(out.depth.at(x, y), first.depth.at(x, y));
        } else if (crop.contains(x, y) && filter == SampleFilter::none && first.valid.at(x, y) > 0) {
          EXPECT_EQ(out.sample_weight.at(x, y), 3);
          const glm::dvec4 mean = (glm::dvec4(first.color.at(x, y)) + glm::dvec4(further[0].color.at(x, y)) +
                                   glm::dvec4(further[1].color.at(x, y))) /
                                  3.0;
          EXPECT_EQ(out.color.at(x, y), glm::vec4(mean));
        }
      }
  }
}

}  // namespace
}  // namespace varve
