// What the measurements against the twins have in common.
#pragma once

#include <string>
#include <vector>

#include "resolve/accumulate.h"
#include "stability/shots.h"
#include "stability/twins.h"

namespace varve::stability {

inline constexpr Window kTwinWindow{-3, 2, 12, 13};

/// The largest |value| of the present and, where given, the history within `reach`: what rounding goes by. Below it
/// floats have no relative steps any more.
double size_around(const Present& present, const History* history, int x, int y, int reach);

struct Input {
  std::string name;
  RawShot shot;
};
std::string words_of(const std::vector<Input>& inputs);

/// The row of a family, made where there is none. `rows` must not grow beyond what is reserved.
Measured& row_of(std::vector<Measured>& rows, const std::string& family, const std::string& inputs, double bound);

void measure_combining(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers);
void measure_gather(bool thorough, std::vector<Measured>& rows, Workers& workers);
void measure_deep(bool thorough, std::vector<Measured>& rows);
void measure_motion(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers);
void measure_moments(bool thorough, std::vector<Measured>& rows, Workers& workers);
void measure_metrics(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers);

}  // namespace varve::stability
