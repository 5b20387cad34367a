// What waits for the past: the same planes come back from memory and from a file.
#include "stages/strict_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "support/scenes.h"

namespace varve {
namespace {

std::vector<StrictSide> sides_of(unsigned seed, bool diagnostics, Workers& workers) {
  std::vector<StrictSide> sides;
  for (const Window w : {Window{0, 0, 33, 7}, Window{-5, 2, -4, 30}, Window{}}) {
    StrictSide side{Plane<glm::vec4>(w), Plane<float>(w), Plane<float>(w), {}, {}, {seed, seed + 1, seed + 2}};
    const Present noise = test::noise_present(w, {seed, 0, 0, 0, false, 1}, workers);
    for (int y = w.y0; y < w.y1; ++y)
      for (int x = w.x0; x < w.x1; ++x) {
        side.color.at(x, y) = noise.color.at(x, y);
        side.total.at(x, y) = noise.color.at(x, y).r;
        side.spread.at(x, y) = noise.color.at(x, y).g;
      }
    if (diagnostics) {
      side.reject = Plane<std::uint32_t>(w, 0, seed);
      side.clip = Plane<float>(w, 0, float(seed) / 3);
    }
    sides.push_back(std::move(side));
  }
  return sides;
}

template <class T>
bool same(const Plane<T>& a, const Plane<T>& b) {
  if (a.empty() != b.empty() || !(a.window() == b.window())) return a.empty() && b.empty();
  for (int y = a.window().y0; y < a.window().y1; ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(T) * std::size_t(a.window().width())) != 0) return false;
  return true;
}

TEST(StrictStore, GivesBackWhatWasPut) {
  Workers workers(1);
  const std::filesystem::path folder = testing::TempDir() + "varve-spill-" + std::to_string(::getpid());
  std::filesystem::create_directory(folder);
  for (const std::string& where : {std::string(), folder.string()}) {
    StrictStore store(where);
    for (int round = 0; round < 2; ++round) {  // the space is used again
      for (const unsigned index : {7u, 3u, 5u}) store.put(index, sides_of(index, index != 3, workers));
      EXPECT_FALSE(store.has(4));
      for (const unsigned index : {3u, 5u}) {
        ASSERT_TRUE(store.has(index));
        const std::vector<StrictSide> back = store.take(index), put = sides_of(index, index != 3, workers);
        EXPECT_FALSE(store.has(index));
        ASSERT_EQ(back.size(), put.size());
        for (std::size_t k = 0; k < put.size(); ++k) {
          EXPECT_TRUE(same(back[k].color, put[k].color) && same(back[k].total, put[k].total) &&
                      same(back[k].spread, put[k].spread) && same(back[k].reject, put[k].reject) &&
                      same(back[k].clip, put[k].clip));
          EXPECT_EQ(back[k].counts.clipped, put[k].counts.clipped);
        }
      }
      store.clear();
      EXPECT_FALSE(store.has(7));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder)) << "the file has no name";
  }
  std::filesystem::remove(folder);
  try {
    StrictStore nowhere(folder.string());
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::output);
  }
}

}  // namespace
}  // namespace varve
