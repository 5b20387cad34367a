// What stays wrong and what changes: the squared error over time as bias and flicker.
#pragma once

#include "diagnose/color_pair.h"

namespace varve {

/// Mean and spread over time of the error b - a of each pixel and component. Per pixel
/// mean_t e^2 = (mean_t e)^2 + var_t e: the first is blur, ghosts and bias, the second flicker. Memory: 64 bytes a
/// pixel. Windows must stay the same; one that differs starts anew and adds what was gathered.
class BiasFlicker {
 public:
  void add(const ColorPair& pair, Workers& workers);

  struct Split {
    double bias = 0, flicker = 0;  ///< mean squares over R, G, B of all pixels
    std::size_t values = 0;        ///< pixels x 3 that were seen in two frames at least
  };
  Split split(Workers& workers) const;

 private:
  struct Moments {
    double mean[3], squares[3];  ///< Welford's running mean and sum of squared distances from it
    double count, unused;
  };
  Split current(Workers& workers) const;
  Plane<Moments> moments_;
  Split finished_;  ///< sums of stretches that ended
};

}  // namespace varve
