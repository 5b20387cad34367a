// What is skipped because it is empty and rests comes out as if it had not been: every bit, every plane, every count.
#include "resolve/empty_spans.h"

#include <gtest/gtest.h>

#include "support/scenes.h"

namespace varve {
namespace {

using test::same_bits;

/// Two moving patches of noise before nothing, now and then a bad pixel far from them.
Present sparse_present(const Window& w, int frame, Workers& workers) {
  Present p = test::noise_present(w, {.seed = unsigned(frame) + 1, .motion = 4}, workers);
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const bool first = x > 20 + 3 * frame && x < 60 + 3 * frame && y > 4 && y < 17;
      const bool second = x > 290 && y > 20 - frame;
      if (first || second) continue;
      p.color.at(x, y) = glm::vec4(0.0f);
      p.motion.at(x, y) = glm::vec2(0.0f);
    }
  if (frame == 3) p.color.at(230, 8).y = std::numeric_limits<float>::quiet_NaN();
  if (frame == 4) p.motion.at(180, 25) = glm::vec2(std::numeric_limits<float>::quiet_NaN());
  if (frame == 5) p.motion.at(181, 3) = glm::vec2(0.5f, 0.0f);
  sanitize(p, workers);
  return p;
}

template <class T>
bool same_plane(const Plane<T>& a, const Plane<T>& b) {
  if (!(a.window() == b.window())) return false;
  for (int y = a.window().y0; y < a.window().y1; ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(T) * std::size_t(a.window().width())) != 0) return false;
  return true;
}

class EmptySpans : public testing::TestWithParam<HistoryFilter> {};

TEST_P(EmptySpans, ChangeNoBit) {
  Workers workers(2);
  RecursiveParameters recursive;
  recursive.history_filter = GetParam();
  for (const int window : {3, 7})
    for (const bool moves : {false, true}) {
      RectifyParameters rectify;
      rectify.window = window;
      History skipping, whole;
      for (int frame = 0; frame < 8; ++frame) {
        const Window w = moves ? Window{frame, -frame, 330 + frame, 30} : Window{0, 0, 330, 31};
        const Present present = sparse_present(w, frame, workers);
        Present like = sparse_present(w, frame, workers);
        like.companions.emplace_back(w, kPresentBorder, glm::vec4(0.0f));  // with these nothing is skipped
        const DiagnosticsWanted all{true, true, true, true};
        Accumulated a = accumulate(present, skipping, recursive, rectify, {}, 1, all, workers);
        Accumulated b = accumulate(like, whole, recursive, rectify, {}, 1, all, workers);
        ASSERT_TRUE(same_bits(a.history.color, b.history.color)) << frame;
        ASSERT_TRUE(same_plane(a.history.total, b.history.total)) << frame;
        ASSERT_TRUE(same_plane(a.history.spread, b.history.spread)) << frame;
        ASSERT_TRUE(same_plane(a.diagnostics.clip, b.diagnostics.clip)) << frame;
        ASSERT_TRUE(same_plane(a.diagnostics.weight, b.diagnostics.weight)) << frame;
        ASSERT_TRUE(same_plane(a.diagnostics.reject, b.diagnostics.reject)) << frame;
        EXPECT_EQ(a.history.rows_valid, b.history.rows_valid);
        EXPECT_EQ(a.counts.restarted, b.counts.restarted);
        EXPECT_EQ(a.counts.clipped, b.counts.clipped);
        EXPECT_EQ(a.counts.rejected, b.counts.rejected);
        skipping = std::move(a.history);
        whole = std::move(b.history);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Filters, EmptySpans,
                         testing::Values(HistoryFilter::bilinear, HistoryFilter::catmull_rom,
                                         HistoryFilter::catmull_rom9, HistoryFilter::catmull_rom5,
                                         HistoryFilter::cubic));

}  // namespace
}  // namespace varve
