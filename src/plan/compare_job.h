// What a user asks of a comparison. Filled by the command line, or by a program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/window.h"
#include "diagnose/metric.h"
#include "exr/channel_names.h"
#include "exr/sequence.h"

namespace varve {

/// A is the reference, B what is judged.
struct CompareJob {
  SequencePattern a, b;
  std::optional<SequencePattern> motion;  ///< files with motion vectors, where neither A nor B has them
  std::vector<int> frames;                ///< empty: all on disk
  std::vector<int> cuts;                  ///< first frames of new shots
  RoleRequest roles_a, roles_b;
  std::vector<std::string> channels = {"color"};  ///< "color", "all", or full channel names
  MetricSet metrics = MetricSet().set();          ///< to be measured
  std::vector<Limit> limits;
  bool common_window = false;  ///< compare where both data windows lie; otherwise they must be the same
  bool nan_equal = false;      ///< NaN against NaN at the same place is the same
  bool attributes = false;     ///< compare attributes too
  double white = 100;          ///< cd/m2 of the linear value 1
  std::optional<Window> edge;  ///< where the edge lies whose sharpness is measured
  std::string heat_folder;     ///< heat maps as EXR and PNG; empty: none
  int threads = 0;             ///< 0: every processor
};

}  // namespace varve
