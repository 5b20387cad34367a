#include "resolve_sequence.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "base/reject.h"
#include "exr/read_frame.h"
#include "exr/write_frame.h"
#include "plan/preset.h"
#include "resolve/accumulate.h"
#include "stages/preflight.h"
#include "stages/previews.h"
#include "stages/read_present.h"
#include "stages/write_resolved.h"

namespace varve {
namespace {

/// What one subject carries from frame to frame.
struct SubjectState {
  History history;
  ForwardMemory forward;
};

/// Made once, used for every frame.
struct Setup {
  const ResolveJob& job;
  SequenceInfo info;
  Plan plan;
  JitterSource jitter;
  std::string parameters, hash;
  std::vector<const Aov*> aovs;  ///< asked for
  std::optional<ColorConversion> into_working_space, out_of_working_space;
  std::optional<DisplayTransform> display;
};

/// Wall time since it was made or last asked.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::vector<const Aov*> chosen_aovs(const OutputRequest& request) {
  std::vector<const Aov*> chosen;
  for (const std::string& name : request.aovs) {
    if (name == "all") {
      chosen.clear();
      for (const Aov& aov : diagnostic_aovs()) chosen.push_back(&aov);
      return chosen;
    }
    const Aov* aov = find_aov(name);
    if (!aov) throw Failure(ExitCode::usage, "there is no diagnostic plane '" + name + "'; see varve help aovs");
    chosen.push_back(aov);
  }
  return chosen;
}

Setup set_up(const ResolveJob& job) {
  const JitterSource jitter = parse_jitter_source(job.jitter);
  SequenceInfo info = probe_sequence(job.input, job.frames, job.roles, jitter);
  check_roles(job, info);
  Plan plan = make_plan(info, job.parameters, job.request, job.threads);
  Setup s{job, std::move(info), std::move(plan), jitter, {}, {}, chosen_aovs(job.request), {}, {}, {}};
  s.parameters = describe_parameters(job, s.info);
  s.hash = hash_of(s.parameters + describe_side_inputs(job));
  // Around the resolve: from the input's space to scene-linear, and from there to the output's.
  if (!job.from_space.empty()) s.into_working_space = ColorConversion::between(job.ocio_config, job.from_space, "");
  const std::string& to = job.to_space.empty() ? job.from_space : job.to_space;
  if (!to.empty()) s.out_of_working_space = ColorConversion::between(job.ocio_config, "scene_linear", to);
  if (!job.preview_folder.empty() && (!job.ocio_config.empty() || std::getenv("OCIO")))
    s.display = DisplayTransform::make(job.ocio_config, "", job.display, job.view);
  else if (!job.display.empty() || !job.view.empty())
    throw Failure(
        ExitCode::usage,
        "--display and --view choose how --preview shows colors and need an OpenColorIO config; give --preview, and "
        "a config with --ocio or the environment variable OCIO");
  return s;
}

/// Frames of a sequence must agree on what is resolved and on what that takes; windows may move.
void check_same_subjects(const FrameHeaders& first, const FrameHeaders& now, const Plan& plan) {
  const std::string where = "frame " + std::to_string(now.frame) + " ('" + now.files.front().path + "')";
  if (now.subjects.size() != first.subjects.size())
    throw Failure(ExitCode::inconsistent, where + " has " + std::to_string(now.subjects.size()) +
                                              " color layers to resolve, frame " + std::to_string(first.frame) +
                                              " has " + std::to_string(first.subjects.size()) +
                                              "; render it again, or leave it out with --frames");
  for (std::size_t i = 0; i < now.subjects.size(); ++i) {
    const Subject &a = first.subjects[i], &b = now.subjects[i];
    const std::string layer = b.layer.empty() ? "the main layer" : "layer '" + b.layer + "'";
    if (a.layer != b.layer || a.view != b.view)
      throw Failure(ExitCode::inconsistent, where + " has " + layer + " where frame " + std::to_string(first.frame) +
                                                " has '" + a.layer +
                                                "'; choose with --layer, or leave the frame out with --frames");
    for (std::size_t k = 0; k < 4; ++k)
      if (a.color[k].has_value() != b.color[k].has_value())
        throw Failure(ExitCode::inconsistent, where + ", " + layer + ": channel " + "RGBA"[k] + " is " +
                                                  (b.color[k] ? "there" : "missing") + " but not so in frame " +
                                                  std::to_string(first.frame) +
                                                  "; render it again, or leave it out with --frames");
    const bool other_vectors =
        a.backward.has_value() != b.backward.has_value() || a.forward.has_value() != b.forward.has_value();
    if ((plan.use_motion && other_vectors) || (plan.use_depth && a.depth.has_value() != b.depth.has_value()))
      throw Failure(ExitCode::inconsistent,
                    where + ", " + layer + ": its depth or motion channels are not those of frame " +
                        std::to_string(first.frame) + "; render it again, or leave it out with --frames");
  }
}

/// Names the frame in what a stage has to say: file names alone need not tell it.
template <typename Work>
auto in_frame(int frame, Work work) {
  try {
    return work();
  } catch (const Failure& failure) {
    throw Failure(failure.code(), "frame " + std::to_string(frame) + ": " + failure.what());
  }
}

/// A finished frame is read again only where a later one needs its history.
bool is_needed(const std::vector<ScheduledFrame>& schedule, std::size_t index) {
  bool needed = !schedule[index].complete;
  for (std::size_t k = index + 1; !needed && k < schedule.size() && !schedule[k].restart; ++k)
    needed = !schedule[k].complete;
  return needed;
}

/// One subject: what stands in the files becomes the present, the present meets its history.
struct Resolved {
  Present present;
  Accumulated accumulated;
  History prediction;         ///< only where the diagnostic plane of that name is asked for
  Plane<glm::vec4> finished;  ///< what is written, where that is not what the history keeps
};

Resolved resolve_subject(const Setup& s, const Subject& subject, const FrameHeaders& headers, const FileSet& pixels,
                         const ScheduledFrame& scheduled, SubjectState& state, FrameReport& report, Workers& workers) {
  const Part& part = headers.files.front().parts[std::size_t(part_of(subject))];
  const Parameters& parameters = s.job.parameters;
  if (scheduled.restart) state = {};
  Resolved r;
  r.present = read_present(
      subject, pixels, part.data_window, part.display_window, {parameters.motion, s.plan.use_depth, s.plan.use_motion},
      s.into_working_space ? &*s.into_working_space : nullptr, state.forward, report.vectors_bad, workers);
  std::optional<glm::dvec2> jitter;
  if (headers.jitter) jitter = glm::dvec2(headers.jitter->x, headers.jitter->y);
  const std::uint32_t restart_bit = scheduled.restart_reason == "first frame" ? kRejectFirstFrame : kRejectCut;
  r.accumulated = accumulate(r.present, state.history, parameters.recursive, parameters.rectify, jitter, restart_bit,
                             diagnostics_wanted(s.aovs), workers);
  const auto is_prediction = [](const Aov* aov) { return aov->name == "prediction"; };
  if (std::any_of(s.aovs.begin(), s.aovs.end(), is_prediction))
    r.prediction = predict(r.present, state.history, parameters.recursive, parameters.rectify, workers);
  if (parameters.finish.sharpen > 0 && scheduled.write)
    r.finished = sharpen(r.accumulated.history.color, r.accumulated.history.total, parameters.finish.sharpen, workers);
  report.pixels += part.data_window.pixels();
  report.not_finite += r.present.not_finite;
  report.restarted += r.accumulated.counts.restarted;
  report.clipped += r.accumulated.counts.clipped;
  return r;
}

WriteOptions write_options(const Setup& s, const std::string& frames_used) {
  return {s.job.zip_level,
          {{"varve:version", version()},
           {"varve:parameters", s.parameters},
           {"varve:hash", s.hash},
           {"varve:frames", frames_used}}};
}

void write_outputs(const Setup& s, const FrameHeaders& headers, const FileSet& pixels,
                   const std::vector<ResolvedSubject>& resolved, const std::string& frames_used, FrameReport& report,
                   Workers& workers) {
  const FileHeader& source = headers.files.front();
  const WriteOptions options = write_options(s, frames_used);
  const std::vector<const Aov*> none;
  const bool apart = s.job.diagnostics.has_value();
  FileOutput color =
      resolved_parts(source, pixels.front(), resolved, apart ? none : s.aovs, s.job.request.keep_channels,
                     s.out_of_working_space ? &*s.out_of_working_space : nullptr, workers);
  for (OutputPart& part : color.parts)
    if (!part.copy_chunks) part.compression = s.job.compression;
  report.half_overflows = color.half_overflows;
  if (apart) {
    const FileOutput diagnostics = diagnostic_parts(source, resolved, s.aovs, workers);
    write_frame(s.job.diagnostics->path(headers.frame), source, diagnostics.parts, options, workers);
  }
  if (!s.job.preview_folder.empty())
    write_previews(s.job.preview_folder, headers.frame, resolved, s.aovs, s.display ? &*s.display : nullptr, workers);
  // The resolved frame goes last: once it is there, everything that belongs to it is.
  write_frame(report.path, source, color.parts, options, workers);
}

}  // namespace

Plan plan_sequence(const ResolveJob& job, SequenceInfo& info) {
  Setup s = set_up(job);
  check_outputs(job, schedule_frames(job, s.info, s.hash));
  info = std::move(s.info);
  return std::move(s.plan);
}

ResolveSummary resolve_sequence(const ResolveJob& job, const ResolveEvents& events) {
  // Probe and plan: headers only.
  Setup s = set_up(job);
  if (events.planned) events.planned(s.info, s.plan);

  // Preflight: what will be written, and whether it can be.
  const std::vector<ScheduledFrame> schedule = schedule_frames(job, s.info, s.hash);
  check_outputs(job, schedule);

  Workers workers(job.threads);
  std::vector<SubjectState> states(s.info.first.subjects.size());
  const ChannelNeeds needs{s.plan.use_depth, s.plan.use_motion, job.request.keep_channels};
  ResolveSummary summary;
  int total = 0, done = 0;
  for (const ScheduledFrame& scheduled : schedule) total += scheduled.write;
  const auto stop = [&] { return summary.stopped = summary.stopped || (events.should_stop && events.should_stop()); };

  for (std::size_t i = 0; i < schedule.size() && !stop(); ++i) {
    const ScheduledFrame& scheduled = schedule[i];
    FrameReport report;
    report.frame = scheduled.frame;
    report.restart = scheduled.restart_reason;
    if (scheduled.write) report.path = job.output.path(scheduled.frame);
    if (events.warning && scheduled.restart && scheduled.restart_reason.starts_with("gap"))
      events.warning("frame " + std::to_string(scheduled.frame) + ": " + scheduled.restart_reason +
                     "; its vectors lead to a frame that is not there, so the history starts anew");

    if (!is_needed(schedule, i)) {
      report.skipped = true;
      ++summary.frames_skipped;
      if (events.frame) events.frame(report, ++done, total);
      continue;
    }

    // Read.
    Stopwatch clock;
    const FrameHeaders headers = read_frame_headers(job.input, scheduled.frame, job.roles, s.jitter);
    check_same_subjects(s.info.first, headers, s.plan);
    FileSet pixels = in_frame(scheduled.frame, [&] { return read_files(headers, needs, workers); });
    report.read_seconds = clock.lap();
    if (stop()) break;

    // Resolve, subject by subject.
    std::vector<Resolved> resolved;
    std::vector<ResolvedSubject> subjects;
    for (std::size_t k = 0; k < headers.subjects.size(); ++k)
      resolved.push_back(
          resolve_subject(s, headers.subjects[k], headers, pixels, scheduled, states[k], report, workers));
    for (std::size_t k = 0; k < resolved.size(); ++k)
      subjects.push_back({&headers.subjects[k], &resolved[k].present, &resolved[k].accumulated, &resolved[k].prediction,
                          &resolved[k].finished});
    report.resolve_seconds = clock.lap();
    if (stop()) break;

    // Write, and remember.
    if (scheduled.write && !scheduled.complete) {
      in_frame(scheduled.frame,
               [&] { write_outputs(s, headers, pixels, subjects, frames_used(schedule, i), report, workers); });
      report.write_seconds = clock.lap();
      report.written = true;
      ++summary.frames_written;
    }
    report.skipped = scheduled.complete;
    summary.frames_skipped += scheduled.complete;
    for (std::size_t k = 0; k < resolved.size(); ++k) states[k].history = std::move(resolved[k].accumulated.history);
    if (events.frame) events.frame(report, scheduled.write ? ++done : done, total);
  }
  return summary;
}

}  // namespace varve
