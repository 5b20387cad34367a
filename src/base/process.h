// Another program, run to its end and measured.
#pragma once

#include <string>
#include <vector>

namespace varve {

/// What the kernel tells of a program that has ended.
struct ProcessRun {
  int code = 0;                              ///< exit code; 128 + n when signal n ended it
  double wall_seconds = 0, cpu_seconds = 0;  ///< cpu: user and system, all threads
  double peak_mib = 0;                       ///< largest resident set
  std::string messages;                      ///< what it wrote to standard error, the first 64 KiB
};

/// Runs `program` with these arguments (its own name is added); standard output is dropped. `scratch` names a file for
/// its messages, removed afterwards. Throws Failure(output) when it cannot be started.
ProcessRun run_process(const std::string& program, const std::vector<std::string>& arguments,
                       const std::string& scratch);

}  // namespace varve
