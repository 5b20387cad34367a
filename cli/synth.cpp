// varve synth.
#include <cstdio>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "signals.h"
#include "synth_sequence.h"

namespace varve::cli {
namespace {

std::vector<std::string> output_folders(const SynthJob& job) {
  const std::filesystem::path folder(job.folder);
  std::vector<std::string> folders = {folder.string()};
  if (job.truth) folders.push_back((folder / "truth").string());
  for (const int n : job.yardsticks) folders.push_back((folder / ("ss" + std::to_string(n))).string());
  return folders;
}

}  // namespace

int run_synth(Settings& settings) {
  SynthJob& job = settings.synth;
  job.threads = settings.job.threads;
  if (job.folder.empty()) throw Failure(ExitCode::usage, "synth needs --output: the folder to write to");
  SynthEvents events;
  events.should_stop = [] { return stop_signal() != 0; };
  if (!settings.quiet)
    events.frame = [](int frame, int done, int total) {
      std::fprintf(stderr, "frame %d: written, PROGRESS: %d%%\n", frame, 100 * done / total);
    };
  watch_signals(output_folders(job));
  const int written = synth_sequence(job, events);
  if (!settings.quiet) std::fprintf(stderr, "%d frames written to %s\n", written, job.folder.c_str());
  return stop_signal() != 0 ? 128 + stop_signal() : int(ExitCode::done);
}

}  // namespace varve::cli
