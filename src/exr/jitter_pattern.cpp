#include "exr/jitter_pattern.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"

namespace varve {
namespace {

using Points = std::vector<Jitter>;

/// Positions in parts of a pixel.
Points fixed(double unit, std::initializer_list<Jitter> points) {
  Points out;
  for (const Jitter& p : points) out.push_back({p.x / unit, p.y / unit});
  return out;
}

/// Numbers in [0, 1) that depend on the seed alone: SplitMix64 (Steele, Lea, Flood 2014).
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  double operator()() { return double(next() >> 11) * 0x1p-53; }
  int below(int n) { return std::min(n - 1, int((*this)() * n)); }

 private:
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

/// Digits of `index` in `base`, mirrored at the radix point.
double radical_inverse(int index, int base) {
  double value = 0, digit = 1;
  for (; index > 0; index /= base) {
    digit /= base;
    value += digit * (index % base);
  }
  return value;
}

Points halton23(const PatternRequest& r) {
  Points out;
  for (int i = 1; i <= r.length; ++i) out.push_back({radical_inverse(i, 2) - 0.5, radical_inverse(i, 3) - 0.5});
  return out;
}

Points hammersley(const PatternRequest& r) {
  Points out;
  for (int i = 0; i < r.length; ++i) out.push_back({double(i) / r.length - 0.5, radical_inverse(i, 2) - 0.5});
  return out;
}

Points r2(const PatternRequest& r) {
  constexpr double plastic = 1.32471795724474602596;  // root of x^3 = x + 1
  Points out;
  for (int i = 1; i <= r.length; ++i) {
    const double x = 0.5 + i / plastic, y = 0.5 + i / (plastic * plastic);
    out.push_back({x - std::floor(x) - 0.5, y - std::floor(y) - 0.5});
  }
  return out;
}

/// Each point is the one of several candidates that lies farthest from all before, across the pixel's edges too.
Points poisson(const PatternRequest& r) {
  constexpr int kCandidates = 32;
  Chance chance(r.seed);
  Points out;
  while (int(out.size()) < r.length) {
    Jitter best;
    double farthest = -1;
    for (int c = 0; c < kCandidates; ++c) {
      const double x = chance() - 0.5, y = chance() - 0.5;
      double nearest = 2;
      for (const Jitter& p : out) {
        const double dx = std::abs(x - p.x), dy = std::abs(y - p.y);
        const double wx = std::min(dx, 1 - dx), wy = std::min(dy, 1 - dy);
        nearest = std::min(nearest, wx * wx + wy * wy);
      }
      if (nearest > farthest) farthest = nearest, best = {x, y};
    }
    out.push_back(best);
  }
  return out;
}

Points stratified(const PatternRequest& r) {
  int edge = 1;
  while (std::int64_t(edge) * edge < r.length) ++edge;
  Chance chance(r.seed);
  std::vector<int> cells(std::size_t(edge) * std::size_t(edge));
  std::iota(cells.begin(), cells.end(), 0);
  Points out;
  for (int i = 0; i < r.length; ++i) {
    const int other = i + chance.below(int(cells.size()) - i);
    std::swap(cells[std::size_t(i)], cells[std::size_t(other)]);
    const int column = cells[std::size_t(i)] % edge, row = cells[std::size_t(i)] / edge;
    const double x = (column + chance()) / edge, y = (row + chance()) / edge;
    out.push_back({x - 0.5, y - 0.5});
  }
  return out;
}

Points random(const PatternRequest& r) {
  Chance chance(r.seed);
  Points out;
  for (int i = 0; i < r.length; ++i) {
    const double x = chance(), y = chance();
    out.push_back({x - 0.5, y - 0.5});
  }
  return out;
}

/// The quarters of the pixel in turn, each visited at a Halton point of its own.
Points quadrants(const PatternRequest& r) {
  constexpr Jitter kMiddles[] = {{-0.25, -0.25}, {0.25, 0.25}, {0.25, -0.25}, {-0.25, 0.25}};
  Points out;
  for (int i = 0; i < r.length; ++i) {
    const Jitter& middle = kMiddles[i % 4];
    const int visit = i / 4 + 1;
    out.push_back({middle.x + radical_inverse(visit, 2) / 2 - 0.25, middle.y + radical_inverse(visit, 3) / 2 - 0.25});
  }
  return out;
}

Points motion_perpendicular(const PatternRequest& r) {
  const double angle = r.direction * std::numbers::pi / 180;
  const Jitter across{-std::sin(angle) / 4, std::cos(angle) / 4};
  return {{-across.x, -across.y}, across};
}

constexpr int kMost = 1 << 20;
constexpr std::string_view kInside = "Pedersen 2016 (INSIDE) and its public code";
constexpr std::string_view kDirect3d = "Direct3D 11, standard multisample patterns";

const JitterPattern kPatterns[] = {
    {"halton23", "Halton in bases 2 and 3, from the first point on: even cover after any number of frames",
     "Halton 1960; Pedersen 2016 with 8 and 16", halton23, 0, kMost},
    {"hammersley", "Hammersley in base 2: evener than Halton, but only when all of its points are used",
     "Hammersley 1960", hammersley, 0, kMost},
    {"r2", "additive recurrence by the plastic number: even cover after any number of frames", "Roberts 2018", r2, 0,
     kMost},
    {"center", "every sample at the pixel center", "no jitter, as a known one",
     [](const PatternRequest&) {
       return Points{{0, 0}};
     },
     1, 0},
    {"two-frame", "two positions a quarter of a pixel off the center, on a diagonal, in turns",
     "Sousa 2011; Wronski 2014",
     [](const PatternRequest&) {
       return fixed(4, {{1, -1}, {-1, 1}});
     },
     2, 0},
    {"uniform4", "the centers of the four quarters of a pixel, around the pixel", kInside,
     [](const PatternRequest&) {
       return fixed(4, {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}});
     },
     4, 0},
    {"helix4", "the same four, so that each frame is on the other side of the middle row from the one before", kInside,
     [](const PatternRequest&) {
       return fixed(4, {{-1, 1}, {1, -1}, {1, 1}, {-1, -1}});
     },
     4, 0},
    {"double-helix", "helix4 and then its steps turned, eight frames", kInside,
     [](const PatternRequest&) {
       return fixed(4, {{-1, 1}, {1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}});
     },
     8, 0},
    {"skew-butterfly", "a long diagonal, then a short one across it", kInside,
     [](const PatternRequest&) {
       return fixed(8, {{-2, 2}, {2, -2}, {1, 1}, {-1, -1}});
     },
     4, 0},
    {"rotated4", "rotated grid: four positions, no two in a row or column", kInside,
     [](const PatternRequest&) {
       return fixed(8, {{-1, 3}, {3, 1}, {1, -3}, {-3, -1}});
     },
     4, 0},
    {"rotated4-helix", "the same four in the order of helix4", kInside,
     [](const PatternRequest&) {
       return fixed(8, {{-1, 3}, {1, -3}, {3, 1}, {-3, -1}});
     },
     4, 0},
    {"quadrants", "the four quarters of a pixel in turn, in each a Halton point: for --accumulator subpixel",
     "Yang et al. 2009", quadrants, 0, kMost},
    {"motion-perpendicular", "two positions a quarter of a pixel to both sides of the motion, see --direction", kInside,
     motion_perpendicular, 2, 0},
    {"msaa1", "one sample, the center", kDirect3d,
     [](const PatternRequest&) {
       return Points{{0, 0}};
     },
     1, 0},
    {"msaa2", "two samples on a diagonal", kDirect3d,
     [](const PatternRequest&) {
       return fixed(16, {{4, 4}, {-4, -4}});
     },
     2, 0},
    {"msaa4", "four samples on a rotated grid", kDirect3d,
     [](const PatternRequest&) {
       return fixed(16, {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}});
     },
     4, 0},
    {"msaa8", "eight samples, no two in a row or column", kDirect3d,
     [](const PatternRequest&) {
       return fixed(16, {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}});
     },
     8, 0},
    {"msaa16", "sixteen samples, no two in a row or column", kDirect3d,
     [](const PatternRequest&) {
       return fixed(16, {{1, 1},
                         {-1, -3},
                         {-3, 2},
                         {4, -1},
                         {-5, -2},
                         {2, 5},
                         {5, 3},
                         {3, -5},
                         {-2, 6},
                         {0, -7},
                         {-4, -6},
                         {-6, 4},
                         {-8, 0},
                         {7, -4},
                         {6, 7},
                         {-7, -8}});
     },
     16, 0},
    {"poisson", "by chance, each as far as can be from those before (best of 32 candidates)", "Mitchell 1991", poisson,
     0, 1 << 12},
    {"stratified", "by chance, one in each cell of a square grid, the cells in an order by chance", "Cook 1986",
     stratified, 0, kMost},
    {"random", "by chance, evenly likely everywhere: clumps, as the sources warn", "Lopez", random, 0, kMost},
};

}  // namespace

std::span<const JitterPattern> jitter_patterns() { return kPatterns; }

const JitterPattern* find_jitter_pattern(std::string_view name) {
  const auto found = std::ranges::find(kPatterns, name, &JitterPattern::name);
  return found == std::end(kPatterns) ? nullptr : found;
}

std::string jitter_pattern_names() {
  std::string names;
  for (const JitterPattern& pattern : kPatterns) names += (names.empty() ? "" : ", ") + std::string(pattern.name);
  return names;
}

std::optional<NamedPattern> parse_pattern(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const JitterPattern* pattern = find_jitter_pattern(text.substr(0, colon));
  if (!pattern) return std::nullopt;
  if (colon == text.size()) return NamedPattern{pattern, pattern->length};
  const std::string_view digits = text.substr(colon + 1);
  const std::string name(pattern->name);
  int length = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), length);
  const bool number = problem == std::errc() && end == digits.data() + digits.size();
  if (pattern->length > 0 && (!number || length != pattern->length))
    throw Failure(ExitCode::usage, std::string(text) + ": " + name + " has " + std::to_string(pattern->length) +
                                       (pattern->length == 1 ? " point" : " points") + "; leave the length out");
  if (pattern->length == 0 && (!number || length < 1 || length > pattern->most))
    throw Failure(ExitCode::usage, std::string(text) + ": the length must be a number from 1 to " +
                                       std::to_string(pattern->most) + ", such as " + name + ":16");
  return NamedPattern{pattern, length};
}

Jitter centroid_of(std::span<const Jitter> points) {
  Jitter sum;
  for (const Jitter& p : points) sum.x += p.x, sum.y += p.y;
  const double n = double(std::max<std::size_t>(1, points.size()));
  return {sum.x / n, sum.y / n};
}

}  // namespace varve
