#include "stages/score_color.h"

#include <cmath>
#include <limits>
#include <utility>

#include "diagnose/edge_mtf.h"
#include "diagnose/hdr_flip.h"
#include "diagnose/row_sums.h"
#include "diagnose/ssim.h"

namespace varve {
namespace {

/// Mean absolute difference of two maps.
double mean_difference(const Plane<float>& a, const Plane<float>& b, Workers& workers) {
  const Window window = a.window();
  const double sum = sum_rows<double>(window, workers, [&](int y) {
    double row = 0;
    for (int x = 0; x < window.width(); ++x) row += std::abs(double(a.row(y)[x]) - double(b.row(y)[x]));
    return row;
  });
  return sum / double(window.pixels());
}

Plane<float> luminance_in(const Plane<glm::vec4>& color, const Window& window) {
  Plane<float> out(window);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) out.at(x, y) = luminance(color.at(x, y));
  return out;
}

void put(MetricValues& values, const ColorError& error) {
  values[MetricId::max] = error.greatest;
  values[MetricId::mean] = error.mean();
  values[MetricId::rmse] = error.rmse();
  values[MetricId::relmse] = error.relmse();
  values[MetricId::psnr] = error.psnr();
  values[MetricId::psnr_tone] = error.psnr_tone();
  values[MetricId::psnr_pu] = error.psnr_pu();
}

}  // namespace

void ColorScore::Mean::add(double value) {
  sum += value;
  ++count;
}
double ColorScore::Mean::value() const { return count ? sum / count : std::numeric_limits<double>::quiet_NaN(); }

void ColorScore::measure_flips(const ColorPair& pair, MetricValues& values, Workers& workers) {
  if (wants(MetricId::ssim)) ssim_.add(values[MetricId::ssim] = ssim(pair, workers));
  if (wants(MetricId::flip))
    flip_.add(values[MetricId::flip] = mean_of(flip_map(pair.a, pair.b, pair.bad, workers), workers));
  if (wants(MetricId::hdr_flip)) {
    const Plane<float> map = hdr_flip_map(pair.a, pair.b, pair.bad, exposure_range(pair.a), workers);
    hdr_flip_.add(values[MetricId::hdr_flip] = mean_of(map, workers));
  }
}

void ColorScore::measure_change(const ColorPair& pair, const Plane<glm::vec2>& motion, MetricValues& values,
                                Workers& workers) {
  if (wants(MetricId::warped) && !motion.empty()) {
    const WarpedResidual residual = warped_residual(pair, *before_, motion, workers);
    values[MetricId::warped] = residual.mean();
    warped_ += residual;
  }
  if (wants(MetricId::ghost)) {
    const Ghost ghost = ghost_of(pair, before_->a, before_->bad, workers);
    values[MetricId::ghost] = ghost.coefficient();
    ghost_ += ghost;
  }
  if (wants(MetricId::tflip) && before_->window() == pair.window()) {
    const Plane<float> test = flip_map(pair.b, before_->b, {}, workers);
    const Plane<float> reference = flip_map(pair.a, before_->a, {}, workers);
    tflip_.add(values[MetricId::tflip] = mean_difference(test, reference, workers));
  }
}

void ColorScore::end_of_shot() {
  if (shares_.size() >= 2) {
    const Lag lag = lag_of(shares_);
    lag_.add(lag.mean_age);
    half_life_.add(lag.half_life);
  }
  shares_.clear();
}

void ColorScore::measure_lag(const ColorPair& pair, bool cut, Workers& workers) {
  if (cut) {
    end_of_shot();
    stale_ = before_->a.clone();
    stale_bad_ = before_->bad.clone();
  }
  if (!stale_.empty()) shares_.push_back(ghost_of(pair, stale_, stale_bad_, workers).coefficient());
}

void ColorScore::measure_edge(const ColorPair& pair, MetricValues& values) {
  if (!job_.edge) return;
  const Window window = intersect(*job_.edge, pair.window());
  const auto a = edge_sharpness(luminance_in(pair.a, window)), b = edge_sharpness(luminance_in(pair.b, window));
  if (!b) return;
  mtf50_.add(values[MetricId::mtf50] = b->mtf50);
  edge_width_.add(values[MetricId::edge_width] = b->width);
  if (a) edge_blur_.add(values[MetricId::edge_blur] = b->variance - a->variance);
}

MetricValues ColorScore::add(ColorPair pair, const Plane<glm::vec2>& motion, Step step, Workers& workers) {
  MetricValues values;
  const ColorError error = color_error(pair, job_.white, table_, workers);
  put(values, error);
  error_ += error;
  measure_flips(pair, values, workers);
  measure_edge(pair, values);
  if (wants(MetricId::sharpness)) {
    const Sharpness sharpness = sharpness_of(pair, workers);
    values[MetricId::sharpness] = sharpness.share();
    sharpness_ += sharpness;
  }
  const bool starts = !before_ || step != Step::follows;
  if (!starts) measure_change(pair, motion, values, workers);
  if (wants(MetricId::bias) || wants(MetricId::flicker)) split_.add(pair, workers);
  if (wants(MetricId::spectrum)) spectrum_.add(pair, starts, workers);
  if (wants(MetricId::lag) || wants(MetricId::half_life)) {
    if (step == Step::gap) end_of_shot(), stale_ = {};
    measure_lag(pair, before_ && step == Step::cut, workers);
  }
  before_ = std::move(pair);
  return values;
}

MetricValues ColorScore::sequence(Workers& workers) const {
  MetricValues values;
  put(values, error_);
  values[MetricId::ssim] = ssim_.value();
  values[MetricId::flip] = flip_.value();
  values[MetricId::hdr_flip] = hdr_flip_.value();
  const BiasFlicker::Split split = split_.split(workers);
  values[MetricId::bias] = split.bias;
  values[MetricId::flicker] = split.flicker;
  values[MetricId::warped] = warped_.mean();
  values[MetricId::spectrum] = spectrum_.fast_share(workers);
  values[MetricId::tflip] = tflip_.value();
  values[MetricId::ghost] = ghost_.coefficient();
  values[MetricId::sharpness] = sharpness_.share();
  ColorScore::Mean lag = lag_, half_life = half_life_;
  if (shares_.size() >= 2) {
    const Lag last = lag_of(shares_);
    lag.add(last.mean_age);
    half_life.add(last.half_life);
  }
  values[MetricId::lag] = lag.value();
  values[MetricId::half_life] = half_life.value();
  values[MetricId::mtf50] = mtf50_.value();
  values[MetricId::edge_width] = edge_width_.value();
  values[MetricId::edge_blur] = edge_blur_.value();
  for (const Metric& metric : metrics())
    if (!wants(metric.id)) values[metric.id] = std::numeric_limits<double>::quiet_NaN();
  return values;
}

}  // namespace varve
