// What a comparison found, and the verdict drawn from it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/metric.h"
#include "stages/match_channels.h"

namespace varve {

/// The figures of one thing that was compared: a color, or a single channel (alpha and those that are no color), which
/// has counts and absolute differences only.
struct ComparisonRow {
  std::string name;
  bool color = false;
  std::vector<MetricValues> frames;  ///< as Comparison::frames; NaN where the thing was not there
  MetricValues sequence;
};

struct FrameFinding {
  int frame = 0;  ///< the first one
  int count = 1;  ///< frames that say the same
  Finding finding;
};

/// A limit and what became of it.
struct LimitResult {
  Limit limit;
  std::string row;
  int frame = 0;  ///< worst frame; without meaning for figures of the sequence
  bool by_frame = false;
  double value = 0;  ///< NaN: could not be measured
};

struct Comparison {
  Verdict verdict = Verdict::incomparable;
  std::string reason;  ///< why A and B are incomparable
  std::vector<int> frames, only_a, only_b;
  std::vector<ComparisonRow> rows;
  std::vector<FrameFinding> findings;
  std::vector<LimitResult> broken;  ///< limits that do not hold, warnings among them
  std::vector<std::size_t> worst;   ///< indices of frames, worst first, three at most
};

/// Fills verdict, broken limits and worst frames from everything else. Equal sides hold every limit.
void judge(Comparison& comparison, const std::vector<Limit>& limits);

}  // namespace varve
