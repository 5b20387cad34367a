// varve jitter.
#include <cstdio>

#include "base/error.h"
#include "commands.h"
#include "report.h"

namespace varve::cli {

int run_jitter(Settings& settings) {
  const JitterListJob& job = settings.jitter;
  const JitterList list = list_jitter(job);
  const std::string text = settings.jitter_json ? jitter_json(job, list) : jitter_csv(job, list);
  if (settings.jitter_file.empty())
    std::fputs(text.c_str(), stdout);
  else
    write_file(settings.jitter_file, text);
  return int(ExitCode::done);
}

}  // namespace varve::cli
