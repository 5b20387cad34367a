// The report as one HTML page that needs nothing else: figures, plots, and pictures of the worst frames.
#pragma once

#include <string>

#include "base/parallel.h"
#include "plan/compare_job.h"
#include "stages/comparison.h"

namespace varve {

/// Reads the worst frames again for their pictures. Without the picture module the page says so and has none.
/// `scratch`: a file name for pictures on their way into the page; removed afterwards.
std::string comparison_page(const Comparison& comparison, const CompareJob& job, const std::string& scratch,
                            Workers& workers);

}  // namespace varve
