// varve probe.
#include <cstdio>
#include <optional>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "plan/describe.h"
#include "stages/probe_motion.h"
#include "stages/settle_layers.h"
#include "stages/vector_table.h"

namespace varve::cli {

namespace {

// Vectors that nobody told the convention of stop a probe by headers; where the pixels are asked, they need not.
ResolveJob readable(const ResolveJob& job, bool asks_pixels) {
  ResolveJob read = job;
  if (!asks_pixels) return read;
  const std::vector<int> frames = job.frames.empty() ? job.input.color.frames_on_disk() : job.frames;
  if (!frames.empty() && !told_by_names(job, frames.front(), parse_jitter_source(job.jitter)))
    read.roles = without_vectors(job.roles);
  return read;
}

}  // namespace

int run_probe(Settings& settings) {
  finish_job(settings);
  const SettledLayers ordered = settle_layers(readable(settings.job, settings.motion));
  const ResolveJob& job = ordered.job;
  const JitterSource jitter = parse_jitter_source(job.jitter);
  const SequenceInfo info = probe_sequence(job.input, job.frames, job.roles, jitter, parse_camera_source(job.camera));
  Plan plan = make_plan(info, job.parameters, job.request, job.threads);
  if (!ordered.note.empty()) plan.notes.push_back(ordered.note);
  std::vector<ChannelStatistics> statistics;
  if (settings.pixels > 0) {
    Workers workers(job.threads);
    statistics = measure_pixels(info, job.input, job.roles, jitter, settings.pixels, workers);
  }
  std::optional<MotionReport> motion;
  if (settings.motion) {
    Workers workers(job.threads);
    motion = probe_motion(settings.job, info.frames, {}, workers);
  }
  std::optional<VectorTable> vectors;
  if (settings.vectors > 0) {
    Workers workers(job.threads);
    vectors = inspect_vectors(job, info, plan, jitter, settings.vectors, workers);
  }
  std::string text = settings.json ? describe_json(info, plan, statistics, motion ? motion_json(*motion) : "")
                                   : describe_text(info, plan, statistics) + (motion ? motion_text(*motion) : "");
  if (vectors && !settings.json) text += vector_table_text(*vectors);
  if (vectors && settings.json)  // one more member of the object
    text.insert(text.rfind('}'), ",\"vectors\":" + vector_table_json(*vectors));
  std::fputs(text.c_str(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  return int(ExitCode::done);
}

}  // namespace varve::cli
