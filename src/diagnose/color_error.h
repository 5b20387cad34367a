// Distance of two pictures, pixel by pixel: absolute, squared, relative, and as PSNR in three encodings.
#pragma once

#include <cstddef>

#include "diagnose/color_pair.h"
#include "diagnose/pu.h"

namespace varve {

/// Sums over R, G and B of all pixels; frames are pooled with +=. Pixels that are bad count with the full range where a
/// range is known (linear, tone, pu), and are left out of the others, where `bad` tells of them.
struct ColorError {
  std::size_t values = 0, bad = 0;  ///< counts of R, G, B values
  double greatest = 0;              ///< |b - a|; +inf when a value is bad
  double absolute = 0, squares = 0;
  double relative = 0;  ///< (b - a)^2 / (a^2 + 0.01 m^2), m the mean luminance of the frame (relMSE)
  double linear = 0;    ///< squares after holding to 0..1
  double tone = 0;      ///< squares after x / (1 + x), negative values counting as 0
  double pu = 0;        ///< squares of PU21 codes over the code of white

  ColorError& operator+=(const ColorError& more);
  double mean() const { return over_good(absolute); }
  double rmse() const;
  double relmse() const { return over_good(relative); }
  double psnr() const { return decibels(linear); }
  double psnr_tone() const { return decibels(tone); }
  double psnr_pu() const { return decibels(pu); }

 private:
  double over_good(double sum) const;
  double decibels(double sum) const;
};

/// `white`: cd/m2 of the linear value 1, whose PU code is the peak of the PU figure.
ColorError color_error(const ColorPair& pair, double white, const PuTable& table, Workers& workers);

}  // namespace varve
