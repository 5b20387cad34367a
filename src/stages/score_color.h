// The figures of one color, frame after frame.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/bias_flicker.h"
#include "diagnose/color_error.h"
#include "diagnose/ghost.h"
#include "diagnose/metric.h"
#include "diagnose/sharpness.h"
#include "diagnose/temporal_spectrum.h"
#include "diagnose/warped_residual.h"
#include "plan/compare_job.h"

namespace varve {

/// How a frame stands to the one before it.
enum class Step { follows, cut, gap };

/// Gathers one color over a sequence; remembers the last pair of frames.
class ColorScore {
 public:
  explicit ColorScore(const CompareJob& job) : job_(job) {}

  /// The figures of the frame. `motion` leads back to the frame before; empty: none is known.
  MetricValues add(ColorPair pair, const Plane<glm::vec2>& motion, Step step, Workers& workers);
  /// Those of everything added.
  MetricValues sequence(Workers& workers) const;

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    void add(double value);
    double value() const;
  };
  bool wants(MetricId id) const { return job_.metrics[std::size_t(id)]; }
  void measure_flips(const ColorPair& pair, MetricValues& values, Workers& workers);
  void measure_change(const ColorPair& pair, const Plane<glm::vec2>& motion, MetricValues& values, Workers& workers);
  void measure_lag(const ColorPair& pair, bool cut, Workers& workers);
  void measure_edge(const ColorPair& pair, MetricValues& values);
  void end_of_shot();

  const CompareJob& job_;
  PuTable table_;
  ColorError error_;
  Mean ssim_, flip_, hdr_flip_, tflip_, mtf50_, edge_width_, edge_blur_, lag_, half_life_;
  BiasFlicker split_;
  TemporalSpectrum spectrum_;
  WarpedResidual warped_;
  Ghost ghost_;
  Sharpness sharpness_;
  std::optional<ColorPair> before_;
  Plane<glm::vec4> stale_;  ///< reference before the last cut
  Plane<std::uint8_t> stale_bad_;
  std::vector<double> shares_;
};

}  // namespace varve
