// A comparison for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "plan/compare_job.h"
#include "stages/comparison.h"

namespace varve {

/// The verdict in one sentence.
std::string verdict_sentence(const Comparison& comparison);
/// What does not hold, and what is not the same about the files: one sentence each.
std::vector<std::string> remarks_of(const Comparison& comparison);
/// A figure in at most 9 characters; "-" for one that was not measured.
std::string figure_text(MetricId metric, double value);
/// Metrics with a figure in some row, in the order of the table.
std::vector<MetricId> metrics_present(const Comparison& comparison);

/// Tables of at most 100 columns.
std::string comparison_text(const Comparison& comparison);
/// One object; figures that were not measured, and infinite ones, are null.
std::string comparison_json(const Comparison& comparison, const CompareJob& job);
/// One line for each frame of each row, and one for the sequence, where the frame is empty.
std::string comparison_csv(const Comparison& comparison);

}  // namespace varve
