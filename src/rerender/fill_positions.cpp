#include "rerender/fill_positions.h"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace varve {
namespace {

constexpr int kFrames = 4;  // samples of frames further away are rarely what a failed pixel has left
constexpr int kCandidates = 1024;

/// Roberts' R2 sequence: fills the square evenly at any length.
glm::dvec2 candidate(int i) {
  constexpr double kPlastic = 1.32471795724474602596;
  const double x = 0.5 + i / kPlastic, y = 0.5 + i / (kPlastic * kPlastic);
  return {x - std::floor(x) - 0.5, y - std::floor(y) - 0.5};
}

/// Squared, in a picture where every pixel has its samples at the same places.
double distance(glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 d = a - b;
  const double x = d.x - std::round(d.x), y = d.y - std::round(d.y);
  return x * x + y * y;
}

double nearest(glm::dvec2 at, int frame, const FramePositions& positions, double best) {
  for (auto it = positions.lower_bound(frame - kFrames); it != positions.end() && it->first <= frame + kFrames; ++it)
    for (const glm::dvec2& other : it->second)
      best = std::fmin(best, distance(at, other) * (1 + std::abs(it->first - frame)));
  return best;
}

}  // namespace

FramePositions fill_positions(const std::map<int, int>& counts, const FramePositions& known) {
  FramePositions found;
  for (const auto& [frame, count] : counts)
    for (int k = 0; k < count; ++k) {
      glm::dvec2 best(0);
      double farthest = -1;
      for (int i = 0; i < kCandidates; ++i) {
        const glm::dvec2 at = candidate(i);
        const double d = nearest(at, frame, found, nearest(at, frame, known, std::numeric_limits<double>::infinity()));
        if (d > farthest) farthest = d, best = at;
      }
      // Seven digits are what file headers keep.
      found[frame].push_back({std::round(best.x * 1e7) / 1e7, std::round(best.y * 1e7) / 1e7});
    }
  return found;
}

}  // namespace varve
