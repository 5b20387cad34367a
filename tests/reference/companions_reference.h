// The slow twin of the companions: straight from what the box did to the color, one pixel at a time.
#pragma once

#include "reference/accumulate_reference.h"

namespace varve::reference {

/// A frame and its history with a companion in the place of the color.
struct AsColor {
  Present present;
  History history;
};
AsColor as_color(const Present& present, const History& previous, std::size_t companion);

/// What companion `c` must become at (x, y), alpha aside. `companion` is its as_color(). Holds where the color's move
/// has one explanation only: no box, a variance box that clips towards the mean, one that clamps, and one that clips
/// towards a present that lies inside it (`determined` tells the latter).
Color companion_pixel(const Present& present, const History& previous, const AsColor& companion,
                      const RecursiveParameters& recursive, const RectifyParameters& rectify, int x, int y,
                      bool& determined);

}  // namespace varve::reference
