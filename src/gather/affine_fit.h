// A plane through scattered values.
#pragma once

#include <algorithm>

#include <glm/vec2.hpp>

namespace varve {

/// Weighted affine fit of a field: value = constant + slope * offset. Where the samples do not span the plane the slope
/// is held back a little, so that samples on a line, or a single one, give what they know. Wide is a vector of doubles.
template <class Wide>
class AffineFit {
 public:
  void add(glm::dvec2 d, double weight, const Wide& value) {
    w_ += weight;
    x_ += weight * d.x, y_ += weight * d.y;
    xx_ += weight * d.x * d.x, xy_ += weight * d.x * d.y, yy_ += weight * d.y * d.y;
    // Shifted by the first value, so that nothing cancels.
    if (count_++ == 0) first_ = value;
    const Wide v = value - first_;
    vv_ += weight * (v * v), v_ += weight * v, vx_ += weight * d.x * v, vy_ += weight * d.y * v;
  }
  int count() const { return count_; }
  double weight() const { return w_; }
  /// True where the slope is known in every direction: the samples do not lie on a line.
  bool spans_plane() const {
    const Spread s = spread();
    // The smaller spread is about the determinant over the sum.
    return count_ >= 5 && s.xx * s.yy - s.xy * s.xy > kFirmSpread * (s.xx + s.yy);
  }
  /// True where the origin does not lie far off the samples, in units of their spread.
  bool is_around() const {
    const Spread s = spread();
    return s.x * s.x * s.yy - 2 * s.x * s.y * s.xy + s.y * s.y * s.xx < kFirmReach * (s.xx * s.yy - s.xy * s.xy);
  }
  /// Weighted mean square of what the plane leaves over, x and y together.
  double misfit() const {
    const double mx = x_ / w_, my = y_ / w_;
    const Wide mean = v_ / w_, cx = vx_ / w_ - mx * mean, cy = vy_ / w_ - my * mean;
    const Slope g = slope();
    const Wide left = vv_ / w_ - mean * mean - g.x * cx - g.y * cy;
    return std::max(left.x + left.y, 0.0);
  }
  /// At the origin of the offsets.
  Wide value() const { return value({0, 0}); }
  /// At an offset of its own.
  Wide value(glm::dvec2 at) const {
    const double mx = x_ / w_, my = y_ / w_;
    const Slope g = slope();
    return first_ + v_ / w_ + g.x * (at.x - mx) + g.y * (at.y - my);
  }
  /// Change of the value per pixel to the right and down.
  struct Slope {
    Wide x, y;
  };
  Slope slope() const {
    Spread s = spread();
    const Wide mean = v_ / w_;
    const double ridge = (spans_plane() ? 1e-9 : 1e-3) * (s.xx + s.yy) + 1e-6;
    s.xx += ridge, s.yy += ridge;
    const Wide cx = vx_ / w_ - s.x * mean, cy = vy_ / w_ - s.y * mean;
    const double det = s.xx * s.yy - s.xy * s.xy;
    return {(cx * s.yy - cy * s.xy) / det, (cy * s.xx - cx * s.xy) / det};
  }

 private:
  static constexpr double kFirmSpread = 0.25;  // squared pixels
  static constexpr double kFirmReach = 4;

  /// Mean of the offsets, and their second moments around it.
  struct Spread {
    double x, y, xx, xy, yy;
  };
  Spread spread() const {
    const double x = x_ / w_, y = y_ / w_;
    return {x, y, xx_ / w_ - x * x, xy_ / w_ - x * y, yy_ / w_ - y * y};
  }

  double w_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
  Wide first_{0}, v_{0}, vv_{0}, vx_{0}, vy_{0};
  int count_ = 0;
};

}  // namespace varve
