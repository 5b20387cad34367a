// Error against time: which settings are worth their time, and whether two ways to judge agree.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace varve {

/// Less is better in both. A point with a NaN is beaten by every other and beats none.
struct TradePoint {
  double seconds = 0, error = 0;
};

/// Middle value; mean of the two middle ones of an even count; NaN for none.
double median(std::vector<double> values);

/// For each point whether no other is at least as good in both and better in one. Equal points stand together.
std::vector<bool> pareto_front(std::span<const TradePoint> points);

/// The fastest point whose error is at most `percent` above the least one; the less wrong one of equally fast ones.
/// None when no error is a number.
std::optional<std::size_t> cheapest_within(std::span<const TradePoint> points, double percent);

/// Spearman's rank correlation of two equally long lists; equal values share their mean rank. NaN for fewer than two
/// pairs, for lists that do not vary, and when a value is NaN.
double rank_correlation(std::span<const double> a, std::span<const double> b);

}  // namespace varve
