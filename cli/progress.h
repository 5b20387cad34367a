// How far the work is, on standard error.
#pragma once

#include <chrono>
#include <string>

#include "resolve_sequence.h"
#include "settings.h"

namespace varve::cli {

class Progress {
 public:
  /// `automatic` becomes a bar on a terminal and plain lines otherwise. Quiet: nothing at all.
  Progress(ProgressStyle style, bool quiet);

  void frame(const FrameReport& report, int done, int total);
  void warning(const std::string& sentence);
  /// What the run waits for.
  void waiting(const std::string& sentence);
  /// The last word: what was written, how long it took.
  void summary(const ResolveSummary& summary);
  /// Leaves the line of the bar, so that other text can follow.
  void leave_line();

  /// Since it was made.
  double seconds() const;

 private:
  void draw(const FrameReport& report, int done, int total);

  ProgressStyle style_;
  bool quiet_;
  bool on_bar_ = false;  ///< the cursor stands behind a bar
  std::chrono::steady_clock::time_point start_;
};

/// "frame 7: 0.031 s read, 0.050 s resolve, 0.040 s write, PROGRESS: 43%", without line feed.
std::string frame_line(const FrameReport& report, int done, int total);

/// "0:07", "12:34", "1:02:03".
std::string clock_text(double seconds);

}  // namespace varve::cli
