// Perceptually uniform encoding of luminance: PU21 (Mantiuk and Azimi 2021, banding and glare fit).
#pragma once

#include <vector>

namespace varve {

/// Code value of a luminance in cd/m2, which is held to 0.005 .. 10000. 100 cd/m2 gives 256.4, 10000 gives 595.4.
double pu_encode(double luminance);

/// The same by table: within 0.001 of pu_encode, and much quicker. NaN counts as the lowest luminance.
class PuTable {
 public:
  PuTable();
  float encode(float luminance) const;

 private:
  std::vector<float> codes_;  ///< at 256 luminances per octave, those whose float has 15 zero bits at the end
};

}  // namespace varve
