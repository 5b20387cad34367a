// History against what else is known of surfaces: depth with its slope, normals, ids, and the vectors of two frames.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "resolve/row_passes.h"
#include "resolve/surface_test.h"

namespace varve {
namespace {

// A vector shorter than this has no direction to speak of: jitter and rounding turn it round.
constexpr double kShortest = 0.5;  // px

// Less than this of a history is none.
constexpr double kNoTrust = 1e-6;

/// The previous position of a pixel on the history's grid: the pixel at or below, and the fractions beyond.
struct Position {
  int x, y;
  float fx, fy;
  double hx, hy;
};

Position previous_position(const AccumulateView& v, int x, int y) {
  const float* motion = v.motion.origin + y * v.motion.stride + 2 * x;
  const double hx = x + v.shift_x + double(motion[0]), hy = y + v.shift_y + double(motion[1]);
  const double bx = std::floor(hx), by = std::floor(hy);
  return {int(bx), int(by), float(hx - bx), float(hy - by), hx, hy};
}

TestedSurface surface_at(const RowPassView& pass, int x, int y) {
  const Present& p = pass.present;
  const RejectParameters& reject = pass.parameters.reject;
  const Window& w = p.color.window();
  SurfaceTests tests;
  tests.depth = tests_depth_apart(pass.parameters) && !p.depth.empty() && !pass.previous.depth.empty();
  tests.normal = reject.normal_angle > 0 && !p.normal.empty() && !pass.previous.normal.empty();
  tests.id = reject.id != IdTest::off && !p.id.empty() && !pass.previous.id.empty();
  tests.depth_tolerance = pass.parameters.depth_tolerance;
  return surface_at(p, tests, reject, x + w.x0, y + w.y0);
}

/// The four history pixels around a position, each tested.
struct SurfaceTest {
  double available = 0, passed = 0, same_id = 0;  // bilinear weights
  unsigned failed = 0;                            // bits of the hard tests that some pixel failed
  unsigned standing = 0;                          // bit i + 2 j: that pixel passed
  glm::dvec4 color{0.0};                          // weighed sum of those that passed
  float total = 0, spread = 0;
};

SurfaceTest test_surface(const RowPassView& pass, const TestedSurface& s, const Position& at) {
  const History& h = pass.previous;
  const Window& w = h.color.window();
  const bool soft = pass.parameters.reject.id == IdTest::soft;
  SurfaceTest r;
  float heaviest = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const float weight = (i ? at.fx : 1 - at.fx) * (j ? at.fy : 1 - at.fy);
      const int x = at.x + i + w.x0, y = at.y + j + w.y0;
      if (!(weight > 0) || !w.contains(x, y) || !(h.total.at(x, y) > 0)) continue;
      unsigned failed = failed_tests(s, h.depth, h.normal, h.id, x, y);
      r.available += double(weight);
      if (!(failed & kRejectId)) r.same_id += double(weight);
      if (soft) failed &= ~unsigned(kRejectId);
      r.failed |= failed;
      if (failed != 0) continue;
      r.standing |= 1u << (i + 2 * j);
      r.total = r.passed == 0 ? h.total.at(x, y) : std::min(r.total, h.total.at(x, y));
      r.passed += double(weight);
      r.color += glm::dvec4(h.color.at(x, y)) * double(weight);
      if (weight > heaviest) heaviest = weight, r.spread = h.spread.at(x, y);
    }
  return r;
}

/// Trust in a history and the tests that speak against it.
struct Verdict {
  double trust = 1;
  unsigned bits = 0;

  void add(double t, unsigned bit) {
    trust *= t;
    if (t <= 0.5) bits |= bit;
  }
};

/// Surface tests of one pixel. Where some of the four history pixels fail, the others stand in.
void judge_surface(const RowPassView& pass, int x, int y, const Position& at, const RowScratch& s, Verdict& verdict) {
  const TestedSurface surface = surface_at(pass, x, y);
  const SurfaceTest t = test_surface(pass, surface, at);
  if (surface.id && pass.parameters.reject.id == IdTest::soft && t.available > 0)
    verdict.add(t.same_id / t.available, kRejectId);
  if (t.failed == 0) return;
  if (!(t.passed >= 0.25)) return verdict.add(0, t.failed);
  const glm::vec4 color(t.color / t.passed);
  for (int k = 0; k < 4; ++k) s.history[4 * x + k] = color[k];
  s.total[x] = t.total;
  s.spread[x] = t.spread;
}

/// Vector tests of one pixel: its vector against that of the nearest history pixel.
void judge_vectors(const RowPassView& pass, int x, int y, const Position& at, Verdict& verdict) {
  const RejectParameters& p = pass.parameters.reject;
  const Plane<glm::vec2>& before = pass.previous.motion;
  const Window& w = before.window();
  const int px = std::clamp(int(std::floor(at.hx + 0.5)), 0, w.width() - 1);
  const int py = std::clamp(int(std::floor(at.hy + 0.5)), 0, w.height() - 1);
  const glm::dvec2 u(before.at(px + w.x0, py + w.y0));
  const float* motion = pass.frame.motion.origin + y * pass.frame.motion.stride + 2 * x;
  const glm::dvec2 v{double(motion[0]), double(motion[1])};
  if (!(std::isfinite(u.x) && std::isfinite(u.y))) return;  // no vector to compare with
  const double length_u = std::sqrt(u.x * u.x + u.y * u.y), length_v = std::sqrt(v.x * v.x + v.y * v.y);
  if (p.speed > 0 && std::abs(length_v - length_u) > p.speed) verdict.add(0, kRejectSpeed);
  if (p.direction > 0 && length_u >= kShortest && length_v >= kShortest) {
    const double cosine = (u.x * v.x + u.y * v.y) / (length_u * length_v);
    if (cosine < std::cos(p.direction * glm::pi<double>() / 180) - 1e-6) verdict.add(0, kRejectDirection);
  }
  if (p.acceleration > 0) {
    const double difference = std::sqrt((v.x - u.x) * (v.x - u.x) + (v.y - u.y) * (v.y - u.y));
    const double low = std::min(p.acceleration_low, p.acceleration);
    const double doubt = difference >= p.acceleration ? 1
                         : difference <= low          ? 0
                                                      : (difference - low) / (p.acceleration - low);
    verdict.add(1 - doubt, kRejectAcceleration);
  }
}

}  // namespace

bool tests_depth_apart(const RecursiveParameters& parameters) {
  return parameters.disocclusion == Disocclusion::depth &&
         (parameters.reject.depth_slope > 0 || parameters.reject.on_reject == OnReject::weight);
}

void test_history(const RowPassView& pass, int y, const RowScratch& s, const RowPassScratch& extra) {
  for (int x = 0; x < pass.frame.width; ++x) {
    extra.trust[x] = 1;
    if (!(s.total[x] > 0)) continue;
    const Position at = previous_position(pass.frame, x, y);
    Verdict verdict;
    if (pass.tests_surfaces) judge_surface(pass, x, y, at, s, verdict);
    if (pass.tests_vectors) judge_vectors(pass, x, y, at, verdict);
    s.reject[x] |= verdict.bits;
    extra.trust[x] = float(verdict.trust);
    if (!(verdict.trust > kNoTrust)) {
      extra.trust[x] = 0;
      if (pass.parameters.reject.on_reject != OnReject::weight) s.total[x] = 0;
    }
  }
}

unsigned standing_taps(const RowPassView& pass, int x, int y) {
  if (!pass.tests_surfaces) return 15;
  const SurfaceTest t = test_surface(pass, surface_at(pass, x, y), previous_position(pass.frame, x, y));
  return t.failed == 0 || !(t.passed >= 0.25) ? 15 : t.standing;
}

void count_bits(const std::uint32_t* reject, int width, std::array<std::size_t, kRejectBits>& counts) {
  std::uint32_t any = 0;
  for (int x = 0; x < width; ++x) any |= reject[x];
  for (std::size_t bit = 0; bit < counts.size(); ++bit) {
    if (!(any >> bit & 1u)) continue;
    std::size_t n = 0;
    for (int x = 0; x < width; ++x) n += reject[x] >> bit & 1u;
    counts[bit] += n;
  }
}

}  // namespace varve
