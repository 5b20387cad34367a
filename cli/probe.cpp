// varve probe.
#include <cstdio>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "plan/describe.h"
#include "stages/order_layers.h"

namespace varve::cli {

int run_probe(Settings& settings) {
  finish_job(settings);
  const OrderedLayers ordered = order_layers(settings.job);
  const ResolveJob& job = ordered.job;
  const JitterSource jitter = parse_jitter_source(job.jitter);
  const SequenceInfo info = probe_sequence(job.input, job.frames, job.roles, jitter);
  Plan plan = make_plan(info, job.parameters, job.request, job.threads);
  if (!ordered.note.empty()) plan.notes.push_back(ordered.note);
  std::vector<ChannelStatistics> statistics;
  if (settings.pixels > 0) {
    Workers workers(job.threads);
    statistics = measure_pixels(info, job.input, job.roles, jitter, settings.pixels, workers);
  }
  const std::string text =
      settings.json ? describe_json(info, plan, statistics) : describe_text(info, plan, statistics);
  std::fputs(text.c_str(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  return int(ExitCode::done);
}

}  // namespace varve::cli
