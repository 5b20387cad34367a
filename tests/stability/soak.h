// Recursion for thousands of frames, beside a twin whose history nothing rounds.
#pragma once

#include <string>
#include <vector>

#include "base/parallel.h"
#include "stability/passes.h"

namespace varve::stability {

/// How the shot of a soak moves: not at all; there and back by a fraction of a pixel, so that everything is read
/// between pixels again and again; or steadily, so that every pixel leaves in the end.
enum class Sway { rest, sway, pan };
const char* name_of(Sway sway);

struct Soaked {
  std::string name;
  int frames = 0;
  double worst = 0;   ///< largest relative difference of any frame from the twin
  double at_end = 0;  ///< that of the last tenth of the frames: no larger where drift is bounded
  double bound = 0;
};

/// Settings through accumulate(), and through reference::accumulate_pixel() with a history in double.
Soaked soak(const std::string& name, const Settings& settings, Sway sway, int frames, Workers& workers);

/// Every preset of presets() whose accumulator is the recursive one, and a few settings besides.
struct SoakCase {
  std::string name;
  Settings settings;
};
std::vector<SoakCase> soak_cases();

/// `frames` frames at rest, each counting the same, against the mean in double: alpha = 1/n.
Soaked soak_mean(int frames, Workers& workers);

/// The same with a fixed alpha of 1e-6, which single floats would stall.
Soaked soak_small_alpha(int frames, Workers& workers);

}  // namespace varve::stability
