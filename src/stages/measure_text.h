// A measurement for people and for programs.
#pragma once

#include <string>

#include "stages/measurement.h"

namespace varve {

/// A table of at most 100 columns where names allow it, notes, and the recommendation.
std::string measure_text(const Measurement& m, const MeasureJob& job);
/// One object; figures that were not measured are null.
std::string measure_json(const Measurement& m, const MeasureJob& job);
/// One line for each setting.
std::string measure_csv(const Measurement& m);

/// The recommended setting as a command line to copy, with the output left to fill in.
std::string command_line(const Measurement& m, const MeasureJob& job);

}  // namespace varve
