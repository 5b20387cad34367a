#include "motion/dilate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace varve {
namespace {

// The 3x3 in reading order.
constexpr std::ptrdiff_t kDown[9] = {-1, -1, -1, 0, 0, 0, 1, 1, 1};
constexpr std::ptrdiff_t kRight[9] = {-1, 0, 1, -1, 0, 1, -1, 0, 1};

constexpr float kNothing = -std::numeric_limits<float>::infinity();

/// How strongly each pixel claims its neighbors: the larger wins, NaN vectors and the border claim nothing.
Plane<float> claims(const Plane<glm::vec2>& motion, const Plane<float>& depth, Dilation dilation, Workers& workers) {
  const Window& w = motion.window();
  Plane<float> claim(w, 1);
  workers.for_rows(w.y0 - 1, w.y1 + 1, [&](int y) {
    float* row = claim.row(y);
    if (y < w.y0 || y >= w.y1) {
      std::fill(row - 1, row + w.width() + 1, kNothing);
      return;
    }
    row[-1] = row[w.width()] = kNothing;
    const glm::vec2* v = motion.row(y);
    for (int x = 0; x < w.width(); ++x) {
      const float length2 = v[x].x * v[x].x + v[x].y * v[x].y;
      // Background is as far as can be, but its vector counts.
      const float near =
          dilation == Dilation::nearest ? std::max(-depth.row(y)[x], -std::numeric_limits<float>::max()) : length2;
      row[x] = length2 >= 0 ? near : kNothing;
    }
  });
  return claim;
}

/// The same where background claims nothing.
Plane<float> claims_of_surfaces(const Plane<float>& claim, const Plane<float>& depth, Workers& workers) {
  Plane<float> surfaces = claim.clone();
  const Window& w = depth.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = 0; x < w.width(); ++x)
      if (std::isinf(depth.row(y)[x])) surfaces.row(y)[x] = kNothing;
  });
  return surfaces;
}

/// For each pixel of a row, which of the 3x3 (0..8 in reading order) claims it most; the pixel itself wins ties, then
/// reading order. Plain loops over the row, one per neighbor, so that they run on vectors.
void choose_row(const Plane<float>& claim, int y, int width, float* strongest, std::int32_t* choice) {
  std::copy_n(claim.row(y), width, strongest);
  std::fill_n(choice, width, 4);
  for (int n = 0; n < 9; ++n) {
    const float* neighbor = claim.row(y + n / 3 - 1) + n % 3 - 1;
    for (int x = 0; x < width; ++x) {
      const bool wins = neighbor[x] > strongest[x];
      choice[x] = wins ? n : choice[x];
      strongest[x] = wins ? neighbor[x] : strongest[x];
    }
  }
}

DilatedMotion dilate(Plane<glm::vec2> motion, const Plane<float>& depth, Dilation dilation, bool surfaces_apart,
                     Workers& workers, SurfaceMarks marks) {
  if (dilation == Dilation::none || (dilation == Dilation::nearest && depth.empty()))
    return {std::move(motion), depth.empty() ? Plane<float>() : depth.clone(), std::move(marks)};
  const Window& w = motion.window();
  const Plane<float> claim = claims(motion, depth, dilation, workers);
  const Plane<float> surface_claim = surfaces_apart ? claims_of_surfaces(claim, depth, workers) : Plane<float>();
  DilatedMotion out{Plane<glm::vec2>(w), depth.empty() ? Plane<float>() : Plane<float>(w), {}};
  if (!marks.id.empty()) out.marks.id = Plane<std::uint32_t>(w);
  if (!marks.normal.empty()) out.marks.normal = Plane<glm::vec3>(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    std::vector<float> strongest(std::size_t(w.width()));
    std::vector<std::int32_t> choice(std::size_t(w.width()));
    choose_row(claim, y, w.width(), strongest.data(), choice.data());
    if (surfaces_apart) {  // background that has none around follows the background
      std::vector<std::int32_t> among_surfaces(choice.size());
      choose_row(surface_claim, y, w.width(), strongest.data(), among_surfaces.data());
      for (int x = 0; x < w.width(); ++x)
        if (strongest[std::size_t(x)] >= 0 || !std::isinf(depth.row(y)[x]))
          choice[std::size_t(x)] = among_surfaces[std::size_t(x)];
    }
    // Where each of the nine lies; rows beyond the window are never chosen.
    const auto take = [&](const auto& from, auto& to) {
      for (int x = 0; x < w.width(); ++x) {
        const int n = choice[std::size_t(x)];
        to.row(y)[x] = from.row(y)[kDown[n] * from.stride() + kRight[n] + x];
      }
    };
    take(motion, out.motion);
    if (!depth.empty()) take(depth, out.depth);
    if (!marks.id.empty()) take(marks.id, out.marks.id);
    if (!marks.normal.empty()) take(marks.normal, out.marks.normal);
  });
  return out;
}

}  // namespace

DilatedMotion dilate_motion(Plane<glm::vec2> motion, const Plane<float>& depth, Dilation dilation, Workers& workers,
                            SurfaceMarks marks) {
  return dilate(std::move(motion), depth, dilation, false, workers, std::move(marks));
}

DilatedMotion dilate_surfaces_apart(Plane<glm::vec2> motion, const Plane<float>& depth, Dilation dilation,
                                    Workers& workers, SurfaceMarks marks) {
  const bool apart = dilation == Dilation::longest && !depth.empty();
  return dilate(std::move(motion), depth, dilation, apart, workers, std::move(marks));
}

}  // namespace varve
