// varve resolve.
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "base/error.h"
#include "base/printable.h"
#include "commands.h"
#include "plan/describe.h"
#include "progress.h"
#include "report.h"
#include "signals.h"
#include "stages/preflight.h"

namespace varve::cli {
namespace {

void check(const Settings& settings) {
  if (settings.job.output.text().empty())
    throw Failure(ExitCode::usage, "resolve needs --output: the files to write, such as out/shot.####.exr");
}

int describe(const Settings& settings) {
  SequenceInfo info;
  const Plan plan = plan_sequence(settings.job, info);
  std::fputs(printable_lines(describe_text(info, plan, {})).c_str(), stdout);
  return int(ExitCode::done);
}

void write_lists(const ResolveJob& job, const RerenderList& list) {
  for (const std::string& path : job.rerender.files)
    write_file(path, path.ends_with(".csv") ? rerender_csv(list) : rerender_json(list, version()));
}

/// Where nobody has looked yet whether the report's name is that of a frame, it must not be taken for one.
bool may_write_report(const RunReport& report, const std::string& path, bool checked) {
  if (checked) return true;
  return report.exit_code != int(ExitCode::usage) && !path.ends_with(".exr") && is_free_for_report(path);
}

/// Writes the report of a run that did not come to its end; what happened matters more than that this may fail, too.
void report_end(const Settings& settings, RunReport& report, bool checked, Progress& progress) {
  const std::string& path = settings.job.report;
  if (path.empty() || !may_write_report(report, path, checked)) return;
  try {
    write_file(path, report_text(report));
  } catch (const Failure& failure) {
    progress.warning(std::string("there is no report: ") + failure.what());
  }
}

void take_plan(RunReport& report, const SequenceInfo& info, const Plan& plan) {
  report.passes = plan.passes;
  report.notes = info.notes;
  report.notes.insert(report.notes.end(), plan.notes.begin(), plan.notes.end());
  report.frames_requested = int(info.frames.size());
}

/// Runs, and fills the report as far as it comes.
void resolve(const Settings& settings, RunReport& report, bool& checked, Progress& progress) {
  ResolveEvents events;
  events.planned = [&](const SequenceInfo& info, const Plan& plan) {
    if (settings.verbose) std::fputs(printable_lines(describe_text(info, plan, {})).c_str(), stderr);
    take_plan(report, info, plan);
  };
  events.checked = [&](const std::string& parameters, const std::string& hash) {
    report.parameters = parameters;
    report.hash = hash;
    checked = true;
  };
  events.frame = [&](const FrameReport& frame, int done, int total) {
    progress.frame(frame, done, total);
    report.summary.frames_written += frame.written;
    report.summary.frames_skipped += frame.skipped;
    if (!settings.job.report.empty()) report.frames.push_back(frame);
  };
  events.warning = [&](const std::string& sentence) {
    progress.warning(sentence);
    report.warnings.push_back(sentence);
  };
  events.waiting = [&](const std::string& sentence) { progress.waiting(sentence); };
  events.should_stop = [] { return stop_signal() != 0; };
  report.summary = resolve_sequence(settings.job, events);
}

}  // namespace

int run_resolve(Settings& settings) {
  check(settings);
  finish_job(settings);
  if (settings.dry_run) return describe(settings);

  Progress progress(settings.progress, settings.quiet);
  RunReport report;
  bool checked = false;
  const auto fail = [&](ExitCode code, const char* sentence) {
    progress.leave_line();
    report.outcome = "failed";
    report.exit_code = int(code);
    report.sentence = sentence;
    report.seconds = progress.seconds();
    report_end(settings, report, checked, progress);
  };
  watch_signals(output_folders(settings.job));
  try {
    resolve(settings, report, checked, progress);
  } catch (const Failure& failure) {
    fail(failure.code(), failure.what());
    throw;
  } catch (const std::bad_alloc&) {
    fail(ExitCode::input, "memory ran out");
    throw;
  } catch (const std::exception& exception) {
    fail(ExitCode::self_check, exception.what());
    throw;
  }
  progress.summary(report.summary);
  report.seconds = progress.seconds();
  if (report.summary.stopped) {
    report.outcome = "stopped";
    report.exit_code = 128 + stop_signal();
    report.sentence = "stopped as asked; --resume goes on from here";
    report_end(settings, report, checked, progress);
    return report.exit_code;
  }
  if (report.summary.rerender) write_lists(settings.job, *report.summary.rerender);
  if (!settings.job.report.empty()) write_file(settings.job.report, report_text(report));
  return report.exit_code;
}

}  // namespace varve::cli
