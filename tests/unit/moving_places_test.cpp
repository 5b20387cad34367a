// Places to test are also chosen where stored vectors differ from most of the picture.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion/moving_places.h"

namespace varve {
namespace {

/// A textured picture of odd size, at rest but for a square of 24 px.
struct Picture {
  Plane<float> tone{Window{-3, 5, 158, 100}}, x{Window{-3, 5, 158, 100}}, y{Window{-3, 5, 158, 100}};

  Picture(float rest, float moves) {
    const Window& w = tone.window();
    for (int py = w.y0; py < w.y1; ++py)
      for (int px = w.x0; px < w.x1; ++px) {
        tone.at(px, py) = 0.5f + 0.2f * float(std::sin(1.3 * px) * std::cos(0.9 * py));
        x.at(px, py) = on_square(px, py) ? moves : rest;
        y.at(px, py) = rest;
      }
  }
  static bool on_square(int px, int py) { return px >= 40 && px < 64 && py >= 30 && py < 54; }
};

TEST(MovingPlaces, LieInsideWhatMoves) {
  Workers workers(2);
  for (const float rest : {0.0f, 0.5f}) {
    const Picture picture(rest, rest + 0.01f);
    const std::vector<Place> places = moving_places(picture.tone, 1, picture.x, picture.y, 40, {}, workers);
    ASSERT_GE(places.size(), 4u);
    for (const Place& p : places) {
      EXPECT_TRUE(Picture::on_square(p.x - kPatchRadius, p.y - kPatchRadius));
      EXPECT_TRUE(Picture::on_square(p.x + kPatchRadius, p.y + kPatchRadius));
    }
    EXPECT_TRUE(moving_places(picture.tone, 1, picture.x, picture.y, 40, places, workers).empty());  // all are taken
  }
}

TEST(MovingPlaces, NothingMovesOrNothingIsFinite) {
  Workers workers(1);
  const Picture still(0.5f, 0.5f);
  EXPECT_TRUE(moving_places(still.tone, 1, still.x, still.y, 40, {}, workers).empty());
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e38f}) {
    const Picture picture(bad, bad);
    EXPECT_TRUE(moving_places(picture.tone, 1, picture.x, picture.y, 40, {}, workers).empty());
    const Picture square(0, bad);
    EXPECT_TRUE(moving_places(square.tone, 1, square.x, square.y, 40, {}, workers).empty());
  }
}

}  // namespace
}  // namespace varve
