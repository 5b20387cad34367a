// Deep pixels the slow way: split, sort, merge, over. After "Interpreting OpenEXR Deep Pixels", one channel of color
// and one of opacity, everything in double.
#pragma once

#include <cstddef>
#include <vector>

namespace varve::reference {

struct Piece {
  double front = 0, back = 0;
  double alpha = 0, color = 0;
  std::vector<double> shares;  ///< of the samples that were given: how much of the opacity is theirs, summing to 1
};

/// Both parts of a volume cut at z, which lies inside it.
std::vector<Piece> split(const Piece& piece, double z);
/// Two pieces in the same place.
Piece merge(const Piece& a, const Piece& b);

/// Splits at every front and back that lies inside a piece, sorts by front and back, merges volumes that coincide.
/// Points are never merged. `shares` of the input are set to say whose each piece is.
std::vector<Piece> tidy(std::vector<Piece> pieces);

struct Flat {
  double color = 0, alpha = 0, transmittance = 1;
  std::vector<double> variation;  ///< of each sample given to tidy()
};
/// Front to back over tidy pieces.
Flat flatten(const std::vector<Piece>& tidy_pieces);

}  // namespace varve::reference
