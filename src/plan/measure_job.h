// What a user asks of a measurement. Filled by the command line, or by a program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/resolve_job.h"
#include "plan/setting.h"

namespace varve {

struct MeasureJob {
  ResolveJob resolve;                      ///< input, frames, roles, threads; its output and parameters are not used
  std::vector<std::string> resolve_words;  ///< the same as arguments of varve resolve, without input and output
  std::optional<SequencePattern> motion;   ///< files with motion vectors, where the input has none
  std::optional<SequencePattern> reference;
  std::vector<Setting> settings;
  bool skip_impossible = false;  ///< leave out, with a warning, settings that the plan refuses; else they end the run
  int repeats = 3;
  std::string baseline;    ///< name of a setting; empty: the preset `standard` where it is among them, else the first
  double within = 5;       ///< percent above the least error that the recommendation may have
  bool leave_out = false;  ///< score without the reference too, and tell how well both agree
  std::string program;     ///< varve itself, run for each time
  std::string scratch;     ///< folder for what the runs write; removed piece by piece
};

}  // namespace varve
