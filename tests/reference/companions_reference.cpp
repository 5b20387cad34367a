#include "reference/companions_reference.h"

#include <algorithm>
#include <cmath>

namespace varve::reference {
namespace {

using Mean = std::array<double, 3>;

Mean mean_around(const Present& p, const Plane<glm::vec4>& plane, int radius, int x, int y, Mean* sigma) {
  Mean mean{}, squares{};
  int n = 0;
  for (int j = y - radius; j <= y + radius; ++j)
    for (int i = x - radius; i <= x + radius; ++i) {
      if (!p.color.window().contains(i, j) || !(p.valid.at(i, j) > 0)) continue;
      for (int k = 0; k < 3; ++k) mean[std::size_t(k)] += double(plane.at(i, j)[k]);
      ++n;
    }
  for (double& m : mean) m /= std::max(n, 1);
  for (int j = y - radius; sigma && j <= y + radius; ++j)
    for (int i = x - radius; i <= x + radius; ++i) {
      if (!p.color.window().contains(i, j) || !(p.valid.at(i, j) > 0)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = double(plane.at(i, j)[int(k)]) - mean[k];
        squares[k] += d * d;
      }
    }
  if (sigma)
    for (std::size_t k = 0; k < 3; ++k) (*sigma)[k] = std::sqrt(squares[k] / std::max(n, 1));
  return mean;
}

/// The history as it is fetched, not rectified.
Pixel history_of(const Present& present, const History& previous, RecursiveParameters recursive, bool dering,
                 HistoryFilter filter, int x, int y) {
  recursive.dering = dering;
  recursive.history_filter = filter;
  RectifyParameters none;
  none.box = Box::none;
  return predict_pixel(present, previous, recursive, none, x, y);
}

}  // namespace

AsColor as_color(const Present& present, const History& previous, std::size_t companion) {
  AsColor c;
  c.present.color = present.companions[companion].clone();
  c.present.valid = present.valid.clone();
  c.present.rows_valid = present.rows_valid;
  if (!present.motion.empty()) c.present.motion = present.motion.clone();
  if (!present.depth.empty()) c.present.depth = present.depth.clone();
  if (previous.empty()) return c;
  c.history.color = previous.companions[companion].clone();
  c.history.total = previous.total.clone();
  c.history.spread = previous.spread.clone();
  if (!previous.depth.empty()) c.history.depth = previous.depth.clone();
  c.history.rows_valid = previous.rows_valid;
  return c;
}

Color companion_pixel(const Present& present, const History& previous, const AsColor& companion,
                      const RecursiveParameters& recursive, const RectifyParameters& rectify, int x, int y,
                      bool& determined) {
  determined = true;
  const glm::vec4 now = companion.present.color.at(x, y), color_now = present.color.at(x, y);
  const Pixel result = accumulate_pixel(present, previous, recursive, rectify, {}, 1, x, y);
  const HistoryFilter filter = recursive.history_filter;
  const Pixel plain = history_of(companion.present, companion.history, recursive, false, filter, x, y);
  if (result.weight == 0 || plain.total <= 0) return {double(now.r), double(now.g), double(now.b), 0};
  const auto color_history = [&](bool dering, HistoryFilter f) {
    return history_of(present, previous, recursive, dering, f, x, y).color;
  };
  // Held between the nearest four as the color was: a part of the way to their mean.
  const Color filtered = color_history(false, filter), held = color_history(recursive.dering, filter),
              nearest = color_history(false, HistoryFilter::bilinear);
  const Color mine =
      history_of(companion.present, companion.history, recursive, false, HistoryFilter::bilinear, x, y).color;
  Color history = plain.color;
  for (std::size_t k = 0; k < 3; ++k)
    if (held[k] != filtered[k])
      history[k] += (mine[k] - history[k]) * (held[k] - filtered[k]) / (nearest[k] - filtered[k]);
  // Rectified as the color was.
  if (rectify.box != Box::none) {
    Mean sigma{};
    const int radius = rectify.window / 2;
    const Mean mean = mean_around(present, present.color, radius, x, y, &sigma);
    const Mean my_mean = mean_around(present, companion.present.color, radius, x, y, nullptr);
    const double floor = 1e-6 * std::max({std::abs(mean[0]), std::abs(mean[1]), std::abs(mean[2])});
    Mean part{};  // of the way, if each channel went by itself
    double far = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double half = rectify.gamma * sigma[k] + floor;
      const double target = rectify.anchor == BoxAnchor::mean ? mean[k] : double(color_now[int(k)]);
      if (std::abs(target - mean[k]) > half) determined = false;
      const double face = std::clamp(held[k], mean[k] - half, mean[k] + half);
      const double end = rectify.rule == BoxRule::clamp ? mean[k] : target;
      part[k] = face == held[k] ? 0 : (face - held[k]) / (end - held[k]);
      far = std::max(far, part[k]);
    }
    // Alpha has a say in how far a clip goes.
    const double alpha_mean = [&] {
      double sum = 0;
      int n = 0;
      for (int j = y - radius; j <= y + radius; ++j)
        for (int i = x - radius; i <= x + radius; ++i)
          if (present.color.window().contains(i, j) && present.valid.at(i, j) > 0)
            sum += double(present.color.at(i, j).a), ++n;
      return sum / std::max(n, 1);
    }();
    determined = determined && (rectify.rule == BoxRule::clamp || alpha_mean == 1);
    if (rectify.rule == BoxRule::clamp) determined = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double target =
          rectify.rule == BoxRule::clamp || rectify.anchor == BoxAnchor::mean ? my_mean[k] : double(now[int(k)]);
      history[k] += (rectify.rule == BoxRule::clamp ? part[k] : far) * (target - history[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) history[k] += (1 - result.weight) * (double(now[int(k)]) - history[k]);
  return history;
}

}  // namespace varve::reference
