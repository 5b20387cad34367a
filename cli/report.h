// The file of --report.
#pragma once

#include <span>
#include <string>

namespace varve::cli {

/// Writes {"version": "...", "frames": [row, ...]} under a temporary name and renames it. Rows are JSON objects.
/// Throws Failure(output) with path and reason.
void write_report(const std::string& path, std::span<const std::string> rows);

}  // namespace varve::cli
