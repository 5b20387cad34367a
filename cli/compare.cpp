// varve compare.
#include "compare_sequence.h"

#include <cstdio>
#include <string>

#include "base/error.h"
#include "base/printable.h"
#include "commands.h"
#include "report.h"
#include "stages/comparison_page.h"
#include "stages/comparison_text.h"

namespace varve::cli {
namespace {

/// Roles of one side: what was said for both, with what was said for this one put above it.
RoleRequest roles_of(const RoleRequest& both, const RoleRequest& side) {
  RoleRequest roles = both;
  if (!side.layers.empty()) roles.layers = side.layers;
  roles.map.insert(roles.map.end(), side.map.begin(), side.map.end());
  return roles;
}

CompareJob finished_job(Settings& settings) {
  CompareJob job = settings.compare;
  job.frames = settings.job.frames;
  job.cuts = settings.job.cuts;
  job.threads = settings.job.threads;
  job.motion = settings.motion_files;
  job.roles_a = roles_of(settings.job.roles, settings.only_a);
  job.roles_b = roles_of(settings.job.roles, settings.only_b);
  // What a limit is put on is measured.
  for (const Limit& limit : job.limits) job.metrics.set(std::size_t(limit.metric));
  return job;
}

int exit_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::equal:
    case Verdict::within:
      return int(ExitCode::done);
    case Verdict::beyond:
      return int(ExitCode::differences);
    case Verdict::incomparable:
      return int(ExitCode::inconsistent);
  }
  return int(ExitCode::self_check);
}

}  // namespace

int run_compare(Settings& settings) {
  const CompareJob job = finished_job(settings);
  const Comparison comparison = compare_sequence(job, {});
  if (settings.json_file != "-") std::fputs(printable_lines(comparison_text(comparison)).c_str(), stdout);
  if (settings.json_file == "-")
    std::fputs(comparison_json(comparison, job).c_str(), stdout);
  else if (!settings.json_file.empty())
    write_file(settings.json_file, comparison_json(comparison, job));
  if (!settings.csv_file.empty()) write_file(settings.csv_file, comparison_csv(comparison));
  if (!settings.html_file.empty()) {
    Workers workers(job.threads);
    write_file(settings.html_file, comparison_page(comparison, job, settings.html_file + ".picture", workers));
  }
  if (comparison.verdict == Verdict::incomparable)
    std::fputs(("varve: error: A and B cannot be compared: " + printable(comparison.reason) + "\n").c_str(), stderr);
  return exit_of(comparison.verdict);
}

}  // namespace varve::cli
