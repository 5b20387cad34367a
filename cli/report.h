// The file of --report.
#pragma once

#include <string>
#include <vector>

#include "help.h"
#include "plan/plan.h"
#include "resolve_sequence.h"

namespace varve::cli {

/// What is told of a run: written when it is done, stopped, or has failed.
struct RunReport {
  std::string outcome = "done";  ///< or "stopped", or "failed"
  int exit_code = 0;
  std::string sentence;          ///< why it stopped or failed
  std::string parameters, hash;  ///< as in the headers of the outputs; empty where it did not come so far
  std::vector<PlannedPass> passes;
  std::vector<std::string> notes, warnings;
  int frames_requested = 0;
  ResolveSummary summary;
  double seconds = 0;  ///< wall time of all
  std::vector<FrameReport> frames;
};

inline constexpr const char* kReportSchema = "varve-report-1";

std::string report_text(const RunReport& report);
/// The JSON Schema (2020-12) that report_text() keeps to.
std::string report_schema();
/// The same as a section of help and manual.
Topic report_topic();

/// Whether a report that was written before stands there, or nothing: else it may be anything that must not be lost.
bool is_free_for_report(const std::string& path);

/// Writes a whole text; the file appears under its name when complete. Throws Failure(output).
void write_file(const std::string& path, const std::string& text);

}  // namespace varve::cli
