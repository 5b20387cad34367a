// varve resolve.
#include <cstdio>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "plan/describe.h"
#include "progress.h"
#include "report.h"
#include "signals.h"

namespace varve::cli {
namespace {

void check(const Settings& settings) {
  if (settings.job.output.text().empty())
    throw Failure(ExitCode::usage, "resolve needs --output: the files to write, such as out/shot.####.exr");
}

int describe(const Settings& settings) {
  SequenceInfo info;
  const Plan plan = plan_sequence(settings.job, info);
  std::fputs(describe_text(info, plan, {}).c_str(), stdout);
  return int(ExitCode::done);
}

void write_lists(const ResolveJob& job, const RerenderList& list) {
  for (const std::string& path : job.rerender.files)
    write_file(path, path.ends_with(".csv") ? rerender_csv(list) : rerender_json(list, version()));
}

std::vector<std::string> output_folders(const ResolveJob& job) {
  const auto folder_of = [](const std::string& path) { return std::filesystem::path(path).parent_path().string(); };
  std::vector<std::string> folders = {folder_of(job.output.text())};
  if (job.diagnostics) folders.push_back(folder_of(job.diagnostics->text()));
  if (!job.preview_folder.empty()) folders.push_back(job.preview_folder);
  return folders;
}

}  // namespace

int run_resolve(Settings& settings) {
  check(settings);
  finish_job(settings);
  if (settings.dry_run) return describe(settings);

  Progress progress(settings.progress, settings.quiet);
  std::vector<std::string> rows;
  ResolveEvents events;
  events.planned = [&](const SequenceInfo& info, const Plan& plan) {
    if (settings.verbose) std::fputs(describe_text(info, plan, {}).c_str(), stderr);
  };
  events.frame = [&](const FrameReport& report, int done, int total) {
    progress.frame(report, done, total);
    if (!settings.job.report.empty()) rows.push_back(frame_json(report));
  };
  events.warning = [&](const std::string& sentence) { progress.warning(sentence); };
  events.should_stop = [] { return stop_signal() != 0; };

  watch_signals(output_folders(settings.job));
  ResolveSummary summary;
  try {
    summary = resolve_sequence(settings.job, events);
  } catch (...) {
    // What was written before stays valid, and so does its report.
    progress.leave_line();
    if (!rows.empty()) write_report(settings.job.report, rows);
    throw;
  }
  progress.summary(summary);
  if (summary.rerender) write_lists(settings.job, *summary.rerender);
  if (!settings.job.report.empty()) write_report(settings.job.report, rows);
  return summary.stopped ? 128 + stop_signal() : int(ExitCode::done);
}

}  // namespace varve::cli
