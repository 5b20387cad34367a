#include "gather/fireflies.h"

#include <algorithm>
#include <cmath>

namespace varve {
namespace {

constexpr double kMostHeld = 0.1;  // share of the samples
constexpr std::size_t kFewest = 5;

float median(std::vector<float>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void hold_fireflies(std::span<const Arrival* const> arrivals, double limit, float* scale, std::vector<float>& work) {
  std::fill(scale, scale + arrivals.size(), 1.0f);
  if (!(limit > 0) || arrivals.size() < kFewest) return;
  work.clear();
  for (const Arrival* a : arrivals) work.push_back(a->light);
  const float middle = median(work);
  for (std::size_t i = 0; i < arrivals.size(); ++i) work[i] = std::fabs(arrivals[i]->light - middle);
  const double most = double(middle) + limit * 1.4826 * double(median(work));
  if (!(most > 0)) return;
  std::size_t beyond = 0;
  for (const Arrival* a : arrivals) beyond += double(a->light) > most;
  if (double(beyond) >= kMostHeld * double(arrivals.size())) return;
  for (std::size_t i = 0; i < arrivals.size(); ++i)
    if (double(arrivals[i]->light) > most) scale[i] = float(most / double(arrivals[i]->light));
}

}  // namespace varve
