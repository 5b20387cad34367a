#include "diagnose/color_pair.h"

#include <cmath>
#include <utility>

#include "diagnose/row_sums.h"

namespace varve {
namespace {

constexpr float kLargestHalf = 65504;

/// False when the two cannot be brought to agreeing finite numbers.
bool make_finite(float& a, float& b, bool nan_equal) {
  if (std::isfinite(a) && std::isfinite(b)) return true;
  if (nan_equal && std::isnan(a) && std::isnan(b)) {
    a = b = 0;
    return true;
  }
  if (a == b) {
    a = b = std::copysign(kLargestHalf, a);
    return true;
  }
  return false;
}

}  // namespace

ColorPair make_color_pair(Plane<glm::vec4> a, Plane<glm::vec4> b, bool nan_equal, Workers& workers) {
  ColorPair pair{std::move(a), std::move(b), {}, 0};
  const Window window = pair.window();
  pair.bad = Plane<std::uint8_t>(window);
  pair.bad_pixels = sum_rows<std::size_t>(window, workers, [&](int y) {
    glm::vec4 *ra = pair.a.row(y), *rb = pair.b.row(y);
    std::size_t count = 0;
    for (int x = 0; x < window.width(); ++x) {
      bool good = true;
      for (int c = 0; c < 3; ++c) good &= make_finite(ra[x][c], rb[x][c], nan_equal);
      if (!std::isfinite(ra[x].a)) ra[x].a = 1;
      if (!std::isfinite(rb[x].a)) rb[x].a = 1;
      pair.bad.row(y)[x] = !good;
      if (!good) ra[x] = rb[x] = glm::vec4(0, 0, 0, 1);
      count += !good;
    }
    return count;
  });
  return pair;
}

}  // namespace varve
