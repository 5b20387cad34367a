// Every pass against its slow twin in double, over the extremes.
#pragma once

#include <string>
#include <vector>

#include "base/parallel.h"

namespace varve::stability {

/// The worst that was found of one family of passes.
struct Measured {
  std::string pass;    ///< the family
  std::string inputs;  ///< what it was given, in words
  long runs = 0;       ///< pass and input together
  long values = 0;     ///< that were compared
  double worst = 0;    ///< difference over the largest value around
  std::string where;   ///< pass and input that it was found with
  double bound = 0;    ///< that it must not exceed

  void take(double difference, double size, const std::string& pass_and_input);
  void add(const Measured& more);
};

/// `thorough`: every pass of the tables over every extreme; else a few of both.
std::vector<Measured> measure_twins(bool thorough, Workers& workers);

}  // namespace varve::stability
