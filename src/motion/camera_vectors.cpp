#include "motion/camera_vectors.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace varve {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kAcross = 64, kDown = 36;  // pixels looked at

// Stored vectors are rounded, to half floats at worst, and averaged over the surfaces of a pixel.
constexpr double kNear = 0.1, kNearShare = 0.02;  // px, and of the length
constexpr double kMoves = 0.5, kApart = 0.02;     // px
constexpr std::size_t kEnough = 32;

double length(glm::dvec2 v) { return std::hypot(v.x, v.y); }
bool within(glm::dvec2 v, double most) { return v.x * v.x + v.y * v.y <= most * most; }

void look_at(const glm::dvec2& pixel, double depth, const glm::dvec2& stored, const CameraChange& change,
             const CameraChange& same_lens, CameraEvidence& e) {
  const glm::dvec2 full = reproject(pixel, depth, change).pixel - pixel;
  const glm::dvec2 bare = reproject(pixel, depth, same_lens).pixel - pixel;
  const double apart = length(full - bare), longest = std::max(length(full), length(bare));
  if (!(longest < 1e6) || !(length(stored) < 1e6)) return;
  const double miss_full = length(stored - full), miss_bare = length(stored - bare);
  const double tolerance = kNear + kNearShare * longest;
  if (longest >= kMoves) {
    ++e.looked_at;
    e.agree += std::min(miss_full, miss_bare) <= tolerance;
    e.zero += stored == glm::dvec2(0);
  }
  if (!(apart >= kApart)) return;
  ++e.lens_tested;
  // Four times nearer to one than to the other, and near to it.
  e.with_lens += miss_full <= tolerance && 4 * miss_full < miss_bare;
  e.without_lens += miss_bare <= tolerance && 4 * miss_bare < miss_full;
}

}  // namespace

CameraEvidence compare_with_camera(const Plane<glm::vec2>& motion, const Plane<float>& depth, glm::dvec2 jitter,
                                   const CameraChange& change) {
  Camera bare = change.to;
  if (change.from.projection == change.to.projection) bare.focal = change.from.focal, bare.center = change.from.center;
  const CameraChange same_lens = change_between(change.from, bare);
  const Window& w = depth.window();
  const int step_x = std::max(1, w.width() / kAcross), step_y = std::max(1, w.height() / kDown);
  CameraEvidence evidence;
  for (int y = w.y0 + step_y / 2; y < w.y1; y += step_y)
    for (int x = w.x0 + step_x / 2; x < w.x1; x += step_x) {
      const float z = depth.at(x, y);
      if (std::isfinite(z))
        look_at(glm::dvec2(x, y) + 0.5 + jitter, double(z), glm::dvec2(motion.at(x, y)), change, same_lens, evidence);
    }
  return evidence;
}

bool all_zero(const CameraEvidence& e) { return e.looked_at >= kEnough && e.zero == e.looked_at; }

bool contradicts(const CameraEvidence& e) { return e.looked_at >= kEnough && e.agree * 50 < e.looked_at; }

bool lacks_lens(const CameraEvidence& e) {
  return e.without_lens >= kEnough && e.without_lens * 50 >= e.lens_tested && e.without_lens > 4 * e.with_lens;
}

bool lens_is_unclear(const CameraEvidence& e) {
  const bool holds = e.with_lens >= kEnough && e.with_lens > 4 * e.without_lens;
  return e.lens_tested > 0 && !holds && !lacks_lens(e);
}

CameraFilled complete_vectors(Plane<glm::vec2>& motion, const Plane<float>& depth, glm::dvec2 jitter,
                              const CameraChange& change, const CameraFill& fill, double max_length, Workers& workers) {
  const bool background = fill.background && !change.sky_rests;
  const bool lens = fill.lens && !change.lens_rests && change.from.projection == change.to.projection;
  if (!background && !lens) return {};
  const Window& window = motion.window();
  std::atomic<std::size_t> filled = 0, added = 0;
  workers.for_rows(window.y0, window.y1, [&](int y) {
    const float* z = depth.row(y);
    glm::vec2* row = motion.row(y);
    std::size_t filled_here = 0, added_here = 0;
    for (int i = 0; i < window.width(); ++i) {
      const bool usable = std::isfinite(row[i].x) && std::isfinite(row[i].y);
      const glm::dvec2 pixel = glm::dvec2(window.x0 + i, y) + 0.5 + jitter;
      if (background && std::isinf(z[i]) && (!usable || row[i] == glm::vec2(0.0f))) {
        const glm::dvec2 way = reproject(pixel, double(z[i]), change).pixel - pixel;
        if (!within(way, max_length)) continue;
        row[i] = glm::vec2(way);
        ++filled_here;
      } else if (lens && usable) {
        const glm::dvec2 way = through_lens(pixel + glm::dvec2(row[i]), change.from, change.to) - pixel;
        row[i] = within(way, max_length) ? glm::vec2(way) : glm::vec2(kNaN);
        ++added_here;
      }
    }
    filled += filled_here;
    added += added_here;
  });
  return {filled, added};
}

void take_out_jitter(Camera& from, Camera& to, const std::optional<glm::dvec2>& jitter_from,
                     const std::optional<glm::dvec2>& jitter_to) {
  const glm::dvec2 moved = to.center - from.center;
  if (moved == glm::dvec2(0)) return;
  if (jitter_from && jitter_to) {
    // A jittered projection shows at the pixel's center what lies at the sample.
    const glm::dvec2 jittered = *jitter_from - *jitter_to;
    if (!(length(jittered) > kApart && length(moved - jittered) <= kApart)) return;
    from.center += *jitter_from;
    to.center += *jitter_to;
    if (length(to.center - from.center) <= kApart) to.center = from.center;
  } else if (std::abs(moved.x) < 1 && std::abs(moved.y) < 1) {
    to.center = from.center;
  }
}

}  // namespace varve
