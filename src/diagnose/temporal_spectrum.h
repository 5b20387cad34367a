// How fast the error changes: its power spectrum over time (Welch 1967).
#pragma once

#include <deque>

#include "diagnose/color_pair.h"

namespace varve {

/// Power of the luminance error in stretches of 16 frames that overlap by half, under a Hann window, summed over
/// pixels. A sequence of 9 to 15 frames is one stretch; a shorter one has no spectrum. Memory: 16 planes.
class TemporalSpectrum {
 public:
  static constexpr int kStretch = 16, kShortest = 9;

  /// The next frame. `restart`: it does not follow the one before.
  void add(const ColorPair& pair, bool restart, Workers& workers);

  /// Share of the power at 1/8 cycle per frame and above, 0..1; a steady error has none, and so has no error at
  /// all. NaN without a stretch.
  double fast_share(Workers& workers) const;

 private:
  struct Power {
    double all = 0, fast = 0;
    Power& operator+=(const Power& more) {
      all += more.all;
      fast += more.fast;
      return *this;
    }
  };
  Power measure(Workers& workers) const;

  std::deque<Plane<float>> errors_;
  Power power_;
  bool measured_ = false;
};

}  // namespace varve
