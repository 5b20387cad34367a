// varve probe.
#include <cstdio>
#include <optional>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "plan/describe.h"
#include "stages/probe_motion.h"

namespace varve::cli {

namespace {

std::vector<int> frames_of(const ResolveJob& job) {
  return job.frames.empty() ? job.input.color.frames_on_disk() : job.frames;
}

}  // namespace

int run_probe(Settings& settings) {
  finish_job(settings);
  const ResolveJob& job = settings.job;
  const JitterSource jitter = parse_jitter_source(job.jitter);
  // Vectors that nobody told the convention of stop a probe by headers; the pixels are asked what they mean.
  const std::vector<int> on_disk = settings.motion ? frames_of(job) : std::vector<int>();
  const bool told = on_disk.empty() || told_by_names(job, on_disk.front(), jitter);
  const RoleRequest roles = told ? job.roles : without_vectors(job.roles);
  const SequenceInfo info = probe_sequence(job.input, job.frames, roles, jitter);
  const Plan plan = make_plan(info, job.parameters, job.request, job.threads);
  std::vector<ChannelStatistics> statistics;
  if (settings.pixels > 0) {
    Workers workers(job.threads);
    statistics = measure_pixels(info, job.input, roles, jitter, settings.pixels, workers);
  }
  std::optional<MotionReport> motion;
  if (settings.motion) {
    Workers workers(job.threads);
    motion = probe_motion(job, info.frames, {}, workers);
  }
  const std::string text = settings.json ? describe_json(info, plan, statistics, motion ? motion_json(*motion) : "")
                                         : describe_text(info, plan, statistics) + (motion ? motion_text(*motion) : "");
  std::fputs(text.c_str(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  return int(ExitCode::done);
}

}  // namespace varve::cli
