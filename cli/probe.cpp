// varve probe.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/printable.h"
#include "commands.h"
#include "plan/describe.h"
#include "stages/check_jitter.h"
#include "stages/probe_motion.h"
#include "stages/sequence_facts.h"
#include "stages/settle_layers.h"
#include "stages/vector_table.h"

namespace varve::cli {
namespace {

/// One more section, or one more member at the end of the object.
void add_to(std::string& text, bool json, const char* member, const std::string& value, const std::string& section) {
  if (json)
    text.insert(text.rfind('}'), std::string(",\"") + member + "\":" + value);
  else
    text += section;
}

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
  JitterSource jitter = parse_jitter_source(job.jitter);
  Workers workers(job.threads);
  if (jitter.kind == JitterSource::Kind::pixels) jitter = measured_jitter(job, workers);
  const SequenceInfo info = probe_sequence(job.input, job.frames, job.roles, jitter, parse_camera_source(job.camera));
  Plan plan = make_plan(info, job.parameters, job.request, job.threads);
  if (!ordered.note.empty()) plan.notes.push_back(ordered.note);
  std::vector<ChannelStatistics> statistics;
  if (settings.pixels > 0) statistics = measure_pixels(info, job.input, job.roles, jitter, settings.pixels, workers);
  std::optional<MotionReport> motion;
  if (settings.motion) motion = probe_motion(settings.job, info.frames, {}, workers);
  std::string text = settings.json ? describe_json(info, plan, statistics, motion ? motion_json(*motion) : "")
                                   : describe_text(info, plan, statistics) + (motion ? motion_text(*motion) : "");
  if (settings.jitter_frames > 0) {
    std::vector<int> frames = info.frames;
    frames.resize(std::min(frames.size(), std::size_t(settings.jitter_frames)));
    const JitterCheck check = check_jitter(job, frames, jitter, workers);
    add_to(text, settings.json, "jitter_check", jitter_check_json(check), jitter_check_text(check));
  }
  if (settings.facts) {
    const SequenceFacts facts = find_facts(job, info.frames, {}, workers);
    add_to(text, settings.json, "facts", facts_json(facts), facts_text(facts));
  }
  if (settings.vectors > 0) {
    const VectorTable vectors = inspect_vectors(job, info, plan, jitter, settings.vectors, workers);
    add_to(text, settings.json, "vectors", vector_table_json(vectors), vector_table_text(vectors));
  }
  std::fputs((settings.json ? text : printable_lines(text)).c_str(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  return int(ExitCode::done);
}

}  // namespace varve::cli
