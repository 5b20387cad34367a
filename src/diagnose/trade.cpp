#include "diagnose/trade.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace varve {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool is_number(const TradePoint& p) { return !std::isnan(p.seconds) && !std::isnan(p.error); }

bool beats(const TradePoint& a, const TradePoint& b) {
  if (!is_number(b)) return is_number(a);
  return a.seconds <= b.seconds && a.error <= b.error && (a.seconds < b.seconds || a.error < b.error);
}

std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    for (std::size_t k = first; k < last; ++k) ranks[order[k]] = 0.5 * double(first + last - 1);
  }
  return ranks;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return kNone;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<bool> pareto_front(std::span<const TradePoint> points) {
  std::vector<bool> front;
  for (const TradePoint& point : points)
    front.push_back(is_number(point) &&
                    std::ranges::none_of(points, [&](const TradePoint& other) { return beats(other, point); }));
  return front;
}

std::optional<std::size_t> cheapest_within(std::span<const TradePoint> points, double percent) {
  double least = INFINITY;
  for (const TradePoint& p : points)
    if (is_number(p)) least = std::min(least, p.error);
  std::optional<std::size_t> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TradePoint& p = points[i];
    if (!is_number(p) || !(p.error <= least * (1 + percent / 100))) continue;
    const bool better = !chosen || p.seconds < points[*chosen].seconds ||
                        (p.seconds == points[*chosen].seconds && p.error < points[*chosen].error);
    if (better) chosen = i;
  }
  return chosen;
}

double rank_correlation(std::span<const double> a, std::span<const double> b) {
  const auto is_nan = [](double v) { return std::isnan(v); };
  if (a.size() != b.size() || a.size() < 2 || std::ranges::any_of(a, is_nan) || std::ranges::any_of(b, is_nan))
    return kNone;
  const std::vector<double> ra = ranks_of(a), rb = ranks_of(b);
  const double mean = 0.5 * double(a.size() - 1);
  double product = 0, squares_a = 0, squares_b = 0;
  for (std::size_t i = 0; i < ra.size(); ++i) {
    product += (ra[i] - mean) * (rb[i] - mean);
    squares_a += (ra[i] - mean) * (ra[i] - mean);
    squares_b += (rb[i] - mean) * (rb[i] - mean);
  }
  return squares_a > 0 && squares_b > 0 ? product / std::sqrt(squares_a * squares_b) : kNone;
}

}  // namespace varve
