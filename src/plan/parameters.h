// Everything that can be tuned: the parameter structs of the passes, together.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "motion/convention.h"

namespace varve {

enum class Dilation { none, nearest, longest };
enum class HistoryFilter { bilinear, catmull_rom, catmull_rom9, catmull_rom5 };
enum class Box { none, minmax, variance, variance_minmax };
enum class BoxRule { clip, clamp };
enum class BoxAnchor { present, mean };
enum class BoxSpace { rgb, ycocg };
enum class AlphaRule { fixed, mean };
enum class SampleFilter { none, tent, gaussian, blackman_harris, mitchell };
enum class Disocclusion { window, depth };
enum class DepthKind { distance, inverse, negative };

/// Which vector a pixel follows, and where its history lies. Sources: Salvi 2016 (longest), Pedersen 2016 (nearest).
struct MotionParameters {
  std::string convention = "auto";          ///< row of the convention table, or auto: by channel names only
  Dilation dilation = Dilation::longest;    ///< choice among the 3x3 neighbors
  double max_length = 16384;                ///< px; longer vectors count as unusable
  DepthKind depth_kind = DepthKind::distance;
};

/// Exponential history, one frame back. Sources: Yang 2009 slide 9, Salvi 2016.
struct RecursiveParameters {
  double alpha = 0.1;                       ///< weight of the present, (0, 1]
  AlphaRule alpha_rule = AlphaRule::mean;   ///< fixed, or max(alpha, 1/n) while n frames have been seen
  HistoryFilter history_filter = HistoryFilter::catmull_rom;
  Disocclusion disocclusion = Disocclusion::window;
  double depth_tolerance = 0.05;            ///< relative depth difference that still is the same surface
  SampleFilter sample_filter = SampleFilter::none;  ///< weight by the true sample position (needs the jitter)
};

/// What history may say. Sources: Salvi 2016 (variance clipping), Pedersen 2016, Lopez.
struct RectifyParameters {
  Box box = Box::variance;
  double gamma = 1.0;                       ///< half size of the variance box in standard deviations
  int window = 3;                           ///< edge of the neighborhood, odd, 3..7
  BoxRule rule = BoxRule::clip;
  BoxAnchor anchor = BoxAnchor::present;    ///< clip towards the present (held inside the box) or the mean
  BoxSpace space = BoxSpace::ycocg;
};

struct Parameters {
  std::string preset = "salvi";
  MotionParameters motion;
  RecursiveParameters recursive;
  RectifyParameters rectify;
};

}  // namespace varve
