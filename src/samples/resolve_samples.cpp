#include "samples/resolve_samples.h"

#include <cmath>
#include <cstdint>

#include "samples/mean_color.h"
#include "samples/weigh_positions.h"

namespace varve {
namespace {

bool positions_known(Samples samples) {
  for (const Present* sample : samples)
    if (!sample->jitter) return false;
  return true;
}

/// What a sample brings to be the one whose surface the pixel shows.
struct Claim {
  bool counts = false, moves = false;
  double length2 = 0;
  float depth = 0;

  bool operator>(const Claim& other) const {
    if (counts != other.counts) return counts;
    if (moves != other.moves) return moves;
    if (length2 != other.length2) return length2 > other.length2;
    return depth < other.depth;
  }
};

/// For each pixel the place of the sample whose vectors, depth and marks it takes.
Plane<std::uint16_t> choose_surfaces(Samples samples, const std::vector<bool>& has_weight, Workers& workers) {
  const Window& w = samples.front()->color.window();
  Plane<std::uint16_t> chosen(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      Claim best;
      for (std::size_t s = 0; s < samples.size(); ++s) {
        const Present& p = *samples[s];
        const Plane<glm::vec2>& vectors = p.motion.empty() ? p.forward : p.motion;
        const glm::dvec2 v = vectors.empty() ? glm::dvec2(0) : glm::dvec2(vectors.at(x, y));
        Claim claim{has_weight[s] && p.valid.at(x, y) > 0, false, v.x * v.x + v.y * v.y,
                    p.depth.empty() ? 0.0f : p.depth.at(x, y)};
        claim.moves = std::isfinite(claim.length2);
        if (!claim.moves) claim.length2 = 0;
        if (s > 0 && !(claim > best)) continue;
        best = claim;
        chosen.at(x, y) = std::uint16_t(s);
      }
    }
  });
  return chosen;
}

/// The plane that `of` names, each pixel from its chosen sample; empty where samples have none.
template <class T>
Plane<T> pick(Samples samples, const Plane<std::uint16_t>& chosen, Plane<T> Present::*of, Workers& workers) {
  if ((samples.front()->*of).empty()) return {};
  const Window& w = chosen.window();
  Plane<T> plane(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) plane.at(x, y) = (samples[chosen.at(x, y)]->*of).at(x, y);
  });
  return plane;
}

Plane<float> mean_mask(Samples samples, Plane<float> Present::*of, Workers& workers) {
  if ((samples.front()->*of).empty()) return {};
  const Window& w = samples.front()->color.window();
  Plane<float> mask(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      double sum = 0;
      for (const Present* sample : samples) sum += double((sample->*of).at(x, y));
      mask.at(x, y) = float(sum / double(samples.size()));
    }
  });
  return mask;
}

/// A pixel is valid where any of its samples is.
void mark_valid(Present& out, Samples samples, Workers& workers) {
  const Window& w = out.color.window();
  out.valid = Plane<float>(w, kPresentBorder, 0.0f);
  out.rows_valid.assign(std::size_t(w.height()), 1);
  std::vector<std::size_t> bad(std::size_t(w.height()), 0);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const auto row = std::size_t(y - w.y0);
    for (int x = w.x0; x < w.x1; ++x) {
      std::size_t valid = 0;
      for (const Present* sample : samples) valid += sample->valid.at(x, y) > 0;
      out.valid.at(x, y) = valid > 0 ? 1.0f : 0.0f;
      if (valid == 0) out.rows_valid[row] = 0;
      bad[row] += valid < samples.size();
    }
  });
  for (const std::size_t pixels : bad) out.not_finite += pixels;
  for (const Present* sample : samples) out.companions_not_finite += sample->companions_not_finite;
}

}  // namespace

Present resolve_samples(Samples samples, SampleFilter filter, Workers& workers, bool show) {
  const bool known = positions_known(samples), weighs = known && filter != SampleFilter::none;
  std::vector<bool> has_weight(samples.size(), true);
  for (std::size_t s = 0; weighs && s < samples.size(); ++s)
    has_weight[s] = position_weight(filter, *samples[s]->jitter) > 0;
  Present out;
  if (weighs) {
    weigh_positions(samples, filter, out, workers, double(samples.size()));
  } else {
    mean_colors(samples, out, workers);
    if (known) {
      glm::dvec2 sum(0);
      for (const Present* sample : samples) sum += *sample->jitter;
      out.jitter = sum / double(samples.size());
    }
  }
  out.companion_is_color = samples.front()->companion_is_color;
  mark_valid(out, samples, workers);
  const Plane<std::uint16_t> chosen = choose_surfaces(samples, has_weight, workers);
  out.motion = pick(samples, chosen, &Present::motion, workers);
  out.forward = pick(samples, chosen, &Present::forward, workers);
  out.depth = pick(samples, chosen, &Present::depth, workers);
  out.id = pick(samples, chosen, &Present::id, workers);
  out.normal = pick(samples, chosen, &Present::normal, workers);
  if (show) {
    const Window& w = chosen.window();
    out.combined.winner = Plane<float>(w);
    workers.for_rows(w.y0, w.y1, [&](int y) {
      for (int x = w.x0; x < w.x1; ++x) out.combined.winner.at(x, y) = float(chosen.at(x, y) + 1);
    });
  }
  out.reactive = mean_mask(samples, &Present::reactive, workers);
  out.responsive = mean_mask(samples, &Present::responsive, workers);
  return out;
}

}  // namespace varve
