#include "gather/noise_share.h"

namespace varve {
namespace {

struct Sums {
  double count = 0, sum = 0, squares = 0;
  void add(double v) { count += 1, sum += v, squares += v * v; }
  /// Of the squared distances from the mean.
  double spread() const { return count > 0 ? squares - sum * sum / count : 0; }
};

/// Bins from well before the tile's edge; casts, since floor() is a call on plain x86-64.
int bin_of(float at) { return int((at + float(kTile)) * kBinsPerPixel); }

bool same_bin(const Arrival& a, const Arrival& b) { return bin_of(a.x) == bin_of(b.x) && bin_of(a.y) == bin_of(b.y); }

}  // namespace

double noise_share(std::span<const Arrival* const> arrivals) {
  constexpr double kFewest = 8;  // pairs of samples, about
  Sums all, bin;
  double within = 0, freedom = 0;
  const double shift = double(arrivals.front()->light);
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const double light = double(arrivals[i]->light) - shift;
    all.add(light);
    bin.add(light);
    if (i + 1 < arrivals.size() && same_bin(*arrivals[i], *arrivals[i + 1])) continue;
    within += bin.spread();
    freedom += bin.count - 1;
    bin = {};
  }
  const double total = all.spread() / (all.count - 1);
  if (!(freedom >= kFewest) || !(total > 0)) return 0;
  return within / freedom / total;
}

}  // namespace varve
