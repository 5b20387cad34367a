// What a measurement found.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "plan/measure_job.h"

namespace varve {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// What a setting costs and how right it is.
struct SettingFigures {
  std::string name;
  double seconds = 0;                    ///< median wall time of a run of the whole program, per frame
  double cpu_seconds = 0;                ///< median of user and system time, per frame
  double pixels_per_second = 0;          ///< of the wall time
  double to_baseline = 0, to_floor = 0;  ///< ratios of wall times
  double peak_mib = 0;                   ///< median of the largest resident set
  /// Against the reference, as in varve compare.
  double psnr_tone = kNotMeasured, flip = kNotMeasured, flicker = kNotMeasured, ghost = kNotMeasured,
         sharpness = kNotMeasured;
  double not_finite = 0;            ///< values in the output; with a reference not the same there
  double leave_out = kNotMeasured;  ///< dB, see LeaveOut
  double unsteady = kNotMeasured;   ///< mean square change along the motion from frame to frame
  double error = kNotMeasured;      ///< mean square that settings are ranked by
  bool on_front = false;
};

struct Measurement {
  std::vector<SettingFigures> settings;
  std::size_t baseline = 0;
  std::optional<std::size_t> recommended;
  double floor_seconds = 0;  ///< per frame: the same channels read and written, nothing resolved
  double floor_mib = 0;
  std::vector<int> frames;  ///< resolved
  std::vector<int> scored;  ///< of them, those with a reference; all without one
  bool with_reference = false;
  double rank_correlation = kNotMeasured;  ///< Spearman's, leave-out against reference; NaN unless both were measured
  std::vector<std::string> notes;          ///< a sentence each
};

}  // namespace varve
