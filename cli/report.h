// The file of --report.
#pragma once

#include <span>
#include <string>

namespace varve::cli {

/// Writes {"version": "...", "frames": [row, ...]} under a temporary name and renames it. Rows are JSON objects.
/// Throws Failure(output) with path and reason.
void write_report(const std::string& path, std::span<const std::string> rows);

/// Writes a whole text; the file appears under its name when complete. Throws Failure(output).
void write_file(const std::string& path, const std::string& text);

}  // namespace varve::cli
