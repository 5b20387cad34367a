#include "stages/find_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace varve {
namespace {

constexpr int kBlocksAcross = 22, kLeastBlock = 8;
constexpr int kQuantiles = 64;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Blocks whose surroundings vary less than this in tone have nothing to compare.
constexpr double kContrast = 0.01;
// And those that vary less than this many times the noise of a block.
constexpr double kAboveNoise = 2;
// Correlation from which on two surroundings are the same thing.
constexpr double kSame = 0.4;

// Where a cut begins. Measured on the scenes of `varve synth`: see tests/unit/find_cut_test.cpp.
constexpr double kUnexplained = 0.5, kUnexplainedAlone = 0.9, kDistance = 0.06, kLeastDistance = 0.01,
                 kDistanceWithoutVectors = 0.1, kDistanceAlone = 0.3, kTurned = 30, kJudged = 0.05;
// Where half of all blocks, flat ones too, are lost, the colors need hardly differ: the most that poor vectors and fast
// motion lost from one frame to the next is a quarter (Beachball; over two frames 0.39).
constexpr double kLostOfAll = 0.5;
// Fewer blocks than these are lost by chance (pictures of some 64x36): up to a distance of 0.12 in the scenes of synth.
constexpr int kFewBlocks = 20;
constexpr double kDistanceOfFew = 0.15;

// Blocks whose light changed by the same factor, up to this one, changed alike. Means of few samples are not surer than
// the second, which will do for steps that are far from none: of small ones it made false alarms in pictures of 64x36.
constexpr double kAgree = 1.1, kAgreeRoughly = 1.3, kLargeStep = 1.45;

/// Means over the valid pixels of the blocks: luma, red and green share; NaN where no pixel is valid.
struct Blocks {
  Plane<float> luma, red, green;
  Plane<float> luma_error;  ///< standard error of the mean: noise, and detail finer than a block
};

/// Mean and sum of squares about it (Welford).
struct Spread {
  double mean = 0, m2 = 0;
  int n = 0;
  void add(double v) {
    const double step = v - mean;
    mean += step / ++n;
    m2 += step * (v - mean);
  }
  double error() const { return n > 0 ? std::sqrt(m2) / n : 0; }
};

/// Standard error of the mean of a block. Lines thinner than a pixel are met by whole rows or columns or not at all, so
/// these are what is independent where they differ more than chance lets them.
double error_of_mean(const Spread& all, const std::vector<Spread>& lines) {
  Spread rows, columns;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].n > 0) (i < lines.size() / 2 ? rows : columns).add(lines[i].mean);
  return std::max({all.error(), rows.error(), columns.error()});
}

Blocks block_means(const Present& p, int block, Workers& workers) {
  const Window& w = p.color.window();
  const Window grid{0, 0, (w.width() + block - 1) / block, (w.height() + block - 1) / block};
  Blocks b{Plane<float>(grid, 0, kNaN), Plane<float>(grid, 0, kNaN), Plane<float>(grid, 0, kNaN),
           Plane<float>(grid, 0, 0.0f)};
  workers.for_rows(0, grid.y1, [&](int by) {
    for (int bx = 0; bx < grid.x1; ++bx) {
      double r = 0, g = 0, bl = 0;
      Spread all;
      std::vector<Spread> lines(std::size_t(2 * block));  // rows, then columns
      for (int y = w.y0 + by * block; y < std::min(w.y1, w.y0 + (by + 1) * block); ++y)
        for (int x = w.x0 + bx * block; x < std::min(w.x1, w.x0 + (bx + 1) * block); ++x) {
          if (!(p.valid.at(x, y) > 0)) continue;
          const glm::vec4& c = p.color.at(x, y);
          const glm::dvec3 light = glm::max(glm::dvec3(c), 0.0);
          r += light.r, g += light.g, bl += light.b;
          const double luma = 0.2126 * light.r + 0.7152 * light.g + 0.0722 * light.b;
          all.add(luma);
          lines[std::size_t((y - w.y0) % block)].add(luma);
          lines[std::size_t(block + (x - w.x0) % block)].add(luma);
        }
      if (all.n == 0) continue;
      const double sum = r + g + bl;
      b.luma.at(bx, by) = float(std::min(all.mean, 1e38));
      b.luma_error.at(bx, by) = float(std::min(error_of_mean(all, lines), 1e38));
      b.red.at(bx, by) = sum > 0 ? float(r / sum) : 1.0f / 3;
      b.green.at(bx, by) = sum > 0 ? float(g / sum) : 1.0f / 3;
    }
  });
  return b;
}

std::vector<float> sorted_values(const Plane<float>& plane) {
  std::vector<float> values;
  const Window& w = plane.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (std::isfinite(plane.at(x, y))) values.push_back(plane.at(x, y));
  std::sort(values.begin(), values.end());
  return values;
}

/// Mean distance of the quantiles (Wasserstein's, of order 1).
double distance_of(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.empty() || b.empty()) return a.empty() == b.empty() ? 0 : 1;
  const auto quantile = [](const std::vector<float>& v, int i) {
    return double(v[std::min(v.size() - 1, (2 * std::size_t(i) + 1) * v.size() / (2 * kQuantiles))]);
  };
  double sum = 0;
  for (int i = 0; i < kQuantiles; ++i) sum += std::abs(quantile(a, i) - quantile(b, i));
  return sum / kQuantiles;
}

/// A value at a position in blocks (integers at block centers); NaN outside.
double read_blocks(const Plane<float>& plane, double x, double y) {
  const Window& w = plane.window();
  if (!(x >= 0 && y >= 0 && x <= w.x1 - 1 && y <= w.y1 - 1)) return double(kNaN);
  const int x0 = int(x), y0 = int(y), x1 = std::min(x0 + 1, w.x1 - 1), y1 = std::min(y0 + 1, w.y1 - 1);
  const double fx = x - x0, fy = y - y0;
  const double top = double(plane.at(x0, y0)) * (1 - fx) + double(plane.at(x1, y0)) * fx;
  const double bottom = double(plane.at(x0, y1)) * (1 - fx) + double(plane.at(x1, y1)) * fx;
  return top * (1 - fy) + bottom * fy;
}

/// Deviations and correlation of the 3x3 blocks around one with what lies at the previous position; n < 9 where some
/// has no partner.
struct Comparison {
  int n = 0;
  double sigma_now = 0, sigma_before = 0, correlation = 0;
};

/// From block centers to display coordinates and along the motion, then to the blocks of the frame before.
glm::dvec2 place_before(const FrameTrace& before, const FrameTrace& now, int bx, int by, glm::dvec2 motion) {
  const double ratio = double(now.block) / before.block;
  return {(bx + 0.5) * ratio - 0.5 + (now.window.x0 - before.window.x0 + motion.x) / before.block,
          (by + 0.5) * ratio - 0.5 + (now.window.y0 - before.window.y0 + motion.y) / before.block};
}

Comparison compare_block(const FrameTrace& before, const FrameTrace& now, int bx, int by, glm::dvec2 motion) {
  double a[9], b[9], mean_a = 0, mean_b = 0;
  Comparison c;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      if (!now.tone.window().contains(bx + i, by + j)) return c;
      const glm::dvec2 at = place_before(before, now, bx + i, by + j, motion);
      const double present = double(now.tone.at(bx + i, by + j)), past = read_blocks(before.tone, at.x, at.y);
      if (!(std::isfinite(present) && std::isfinite(past))) return c;
      a[c.n] = present, b[c.n] = past;
      mean_a += present / 9, mean_b += past / 9;
      ++c.n;
    }
  double aa = 0, bb = 0, ab = 0;
  for (int k = 0; k < 9; ++k) {
    aa += (a[k] - mean_a) * (a[k] - mean_a);
    bb += (b[k] - mean_b) * (b[k] - mean_b);
    ab += (a[k] - mean_a) * (b[k] - mean_b);
  }
  c.sigma_now = std::sqrt(aa / 9);
  c.sigma_before = std::sqrt(bb / 9);
  c.correlation = aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
  return c;
}

/// The rotation between two matrices with orthogonal axes, in degrees.
double turned_between(const std::vector<double>& a, const std::vector<double>& b) {
  double trace = 0, size_a = 0, size_b = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      trace += a[4 * i + k] * b[4 * i + k];
      size_a += a[4 * i + k] * a[4 * i + k];
      size_b += b[4 * i + k] * b[4 * i + k];
    }
  if (!(size_a > 0 && size_b > 0)) return 0;
  const double cosine = (3 * trace / std::sqrt(size_a * size_b) - 1) / 2;
  return std::isfinite(cosine) ? std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / 3.14159265358979323846 : 0;
}

/// Where the middle of a block goes; 0 without vectors.
glm::dvec2 motion_of(const FrameTrace& now, int bx, int by, int steps) {
  return now.motion.empty() ? glm::dvec2(0) : glm::dvec2(now.motion.at(bx, by)) * double(steps);
}

void compare_blocks(const FrameTrace& before, const FrameTrace& now, int steps, CutEvidence& e) {
  const Window& grid = now.tone.window();
  int judged = 0, lost = 0;
  for (int by = 0; by < grid.y1; ++by)
    for (int bx = 0; bx < grid.x1; ++bx) {
      const glm::dvec2 motion = motion_of(now, bx, by, steps);
      if (!(std::isfinite(motion.x) && std::isfinite(motion.y))) continue;
      const Comparison c = compare_block(before, now, bx, by, motion);
      const double noise = kAboveNoise * double(now.error.at(bx, by));
      if (c.n < 9 || !(std::max(c.sigma_now, c.sigma_before) > std::max(kContrast, noise))) continue;
      ++judged;
      // Structure on one side only is as unlike as can be.
      if (!(c.correlation >= kSame)) ++lost;
    }
  e.blocks = judged;
  e.judged = double(judged) / double(std::max<std::size_t>(1, grid.pixels()));
  e.unexplained = judged > 0 ? double(lost) / judged : 0;
}

std::string in_words(const CutEvidence& e) {
  char text[256];
  std::snprintf(text, sizeof text, "%.0f %% of the picture %s, its colors differ by %.2f", 100 * e.unexplained,
                e.with_vectors ? "is not what its vectors lead to" : "is not what stood there", e.distance);
  std::string words = text;
  if (e.turned > 0.5) {
    std::snprintf(text, sizeof text, ", the camera turned by %.0f degrees", e.turned);
    words += text;
  }
  return words;
}

}  // namespace

FrameTrace trace_of(const Present& present, const Plane<glm::vec2>& motion,
                    const std::optional<std::vector<double>>& world_to_camera, int frame, Workers& workers) {
  FrameTrace t;
  t.frame = frame;
  t.window = present.color.window();
  if (t.window.empty()) return t;
  t.block = std::max(kLeastBlock, std::min(t.window.width(), t.window.height()) / kBlocksAcross);
  Blocks blocks = block_means(present, t.block, workers);
  const std::vector<float> lumas = sorted_values(blocks.luma);
  const double median = lumas.empty() ? 0 : double(lumas[lumas.size() / 2]);
  const Window& grid = blocks.luma.window();
  t.tone = Plane<float>(grid);
  t.error = Plane<float>(grid);
  for (int y = 0; y < grid.y1; ++y)
    for (int x = 0; x < grid.x1; ++x) {
      const double l = double(blocks.luma.at(x, y)), sum = l + median;
      t.tone.at(x, y) = sum == 0 ? 0.0f : float(l / sum);
      t.error.at(x, y) = sum == 0 ? 0.0f : float(double(blocks.luma_error.at(x, y)) / sum * (median / sum));
    }
  t.tones = sorted_values(t.tone);
  t.reds = sorted_values(blocks.red);
  t.greens = sorted_values(blocks.green);
  t.luma = std::move(blocks.luma);
  t.world_to_camera = world_to_camera;
  if (motion.empty()) return t;
  t.motion = Plane<glm::vec2>(grid);
  const Window& w = t.window;
  for (int y = 0; y < grid.y1; ++y)
    for (int x = 0; x < grid.x1; ++x)
      t.motion.at(x, y) = motion.at(std::min(w.x1 - 1, w.x0 + x * t.block + t.block / 2),
                                    std::min(w.y1 - 1, w.y0 + y * t.block + t.block / 2));
  return t;
}

CutEvidence judge_cut(const FrameTrace& before, const FrameTrace& now, int steps) {
  CutEvidence e;
  if (before.empty() || now.empty()) return e;
  e.with_vectors = !now.motion.empty();
  compare_blocks(before, now, steps, e);
  e.distance = distance_of(before.tones, now.tones) + distance_of(before.reds, now.reds) +
               distance_of(before.greens, now.greens);
  if (before.world_to_camera && now.world_to_camera)
    e.turned = turned_between(*before.world_to_camera, *now.world_to_camera);
  const bool few = e.blocks < kFewBlocks;
  const double far = few ? kDistanceOfFew : e.with_vectors ? kDistance : kDistanceWithoutVectors;
  const bool beyond_doubt = e.unexplained > kUnexplainedAlone || e.unexplained * e.judged > kLostOfAll;
  const bool lost =
      e.unexplained > kUnexplained && (e.distance > far || e.turned > kTurned ||
                                       (e.with_vectors && !few && beyond_doubt && e.distance > kLeastDistance));
  // Flat pictures have nothing to follow; there only the colors tell.
  e.cut = e.judged >= kJudged ? lost : e.distance > kDistanceAlone;
  e.sentence = in_words(e);
  return e;
}

ExposureStep exposure_step(const FrameTrace& before, const FrameTrace& now, int steps) {
  if (before.empty() || now.empty()) return {};
  std::vector<double> ratios;
  const Window& grid = now.tone.window();
  std::size_t compared = 0;
  for (int by = 0; by < grid.y1; ++by)
    for (int bx = 0; bx < grid.x1; ++bx) {
      const glm::dvec2 at = place_before(before, now, bx, by, motion_of(now, bx, by, steps));
      const double past = read_blocks(before.luma, at.x, at.y), present = double(now.luma.at(bx, by));
      if (!(std::isfinite(past) && std::isfinite(present))) continue;
      ++compared;
      const double ratio = present / past;
      if (past > 0 && present > 0 && std::isfinite(ratio)) ratios.push_back(ratio);
    }
  if (ratios.empty()) return {};
  std::sort(ratios.begin(), ratios.end());
  ExposureStep step;
  step.ratio = ratios[ratios.size() / 2];
  const double size = std::max(step.ratio, 1 / step.ratio);
  // A block that is nearer to no step than to this one does not agree.
  const double within = size > kLargeStep ? std::min(std::sqrt(size), kAgreeRoughly) : kAgree;
  const auto agree = [&](double r) { return r > step.ratio / within && r < step.ratio * within; };
  step.agreed = double(std::count_if(ratios.begin(), ratios.end(), agree)) / double(compared);
  return step;
}

}  // namespace varve
