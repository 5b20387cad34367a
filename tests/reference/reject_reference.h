// The slow twins of the row passes around the kernel: tests of history, weights of the present, what is done after.
#pragma once

#include "reference/accumulate_reference.h"

namespace varve::reference {

/// What a history is worth, and what stands in where some of its four pixels belong to another surface.
struct Judged {
  double trust = 1;
  unsigned bits = 0;
  bool replaced = false;
  Color color{};
  double total = 0, spread = 0;
};
Judged judge(const Present& present, const History& previous, const RecursiveParameters& p, int x, int y);

/// Weight of the present. `fetched` is the history before the rectification, `history` after it; w the sample weight.
/// `total` becomes what the pixel remembers; `reactive` is set where the mask takes half or more.
double weight_of_present(const Present& present, const RecursiveParameters& p, double gamma, const Color& now,
                         const Color& fetched, const Color& history, double trust, double w, double& total,
                         bool& reactive, int x, int y);

/// The blend by logarithms, one channel.
double log_blend(double history, double present, double share, double exposure);

/// Weights 1 2 1 both ways over the valid pixels.
Color softened(const Present& present, int x, int y);

}  // namespace varve::reference
