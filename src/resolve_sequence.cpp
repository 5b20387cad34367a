#include "resolve_sequence.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "exr/temporary_file.h"
#include "stages/accumulate_frame.h"
#include "stages/combine_resolved.h"
#include "stages/continue_history.h"
#include "stages/evaluate_colors.h"
#include "stages/follow_motion.h"
#include "stages/frame_window.h"
#include "stages/half_vectors.h"
#include "stages/preflight.h"
#include "stages/provenance.h"
#include "stages/resume.h"
#include "stages/sequence_facts.h"
#include "stages/set_up.h"
#include "stages/settle_vectors.h"
#include "stages/two_sided_pass.h"
#include "stages/wait_for_frames.h"
#include "stages/write_outputs.h"

namespace varve {
namespace {

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

/// Cuts in the pixels, and what else is worth a word, before any frame meets another.
std::map<int, std::string> look_for_cuts(const Setup& s, const ResolveEvents& events, const std::function<bool()>& stop,
                                         Workers& workers) {
  const SequenceFacts facts = find_facts(s.job, frames_in_reach(s.job, s.info), stop, workers);
  for (const SequenceFact& fact : facts.facts) {
    if (!events.warning || fact.kind == SequenceFact::Kind::gap) continue;
    const std::string frame = "frame " + std::to_string(fact.frame);
    if (fact.kind == SequenceFact::Kind::cut)
      events.warning(frame + " is taken for the first of a new shot: " + fact.evidence +
                     "; --find-cuts off lets history pass");
    else
      events.warning(frame + " (" + name_of(fact.kind) + "): " + fact.evidence);
  }
  return facts.cuts();
}

/// What is written where that is not what the history keeps; else empty. What stands in for a pixel is sharpened too.
Plane<glm::vec4> finish(const Present& present, const History& resolved, const Parameters& parameters,
                        Workers& workers) {
  Plane<glm::vec4> shown = fall_back(present, resolved, parameters.fallback, workers);
  if (!(parameters.finish.sharpen > 0)) return shown;
  return sharpen(shown.empty() ? resolved.color : shown, resolved.total, parameters.finish.sharpen, workers);
}

/// What is written, in the order of headers.outputs.
ResolvedColors colors_to_write(const Setup& s, const SourceFrame& source, const std::vector<Resolved>& resolved,
                               Workers& workers) {
  ResolvedColors written = combine_resolved(source, resolved, {s.job.roles, shows_combined(s.aovs)}, workers);
  for (ResolvedSubject& color : written.colors)
    color.finished =
        &written.finished.emplace_back(finish(*color.present, color.accumulated->history, s.job.parameters, workers));
  return written;
}

void count(FrameReport& report, const SourceFrame& source, const std::vector<Resolved>& resolved, Workers& workers) {
  const std::vector<bool> single = are_single_subjects(source.headers);
  report.vectors_bad += source.vectors_bad;
  report.with_vectors = source.by_camera.pixels;
  report.by_camera = source.by_camera.made + source.by_camera.background;
  report.lens_added = source.by_camera.lens;
  for (const ColorOutput& output : source.headers.outputs)
    if (output.combine == Combine::samples) report.samples = std::max(report.samples, int(output.inputs.size()));
  report.deep_samples += source.deep.samples;
  report.deep_repaired += source.deep.defects.total();
  for (const std::vector<MotionRepair>* repairs : {&source.repairs, &source.forward_repairs})
    for (const MotionRepair& repair : *repairs) {
      report.vectors += repair.census;
      for (std::size_t how = 0; how < repair.count.size(); ++how) report.vectors_by[how] += repair.count[how];
    }
  for (std::size_t k = 0; k < resolved.size(); ++k) {
    report.pixels += source.presents[k].color.window().pixels();
    report.not_finite += source.presents[k].not_finite;
    report.restarted += resolved[k].accumulated.counts.restarted;
    report.clipped += resolved[k].accumulated.counts.clipped;
    report.removed_light += resolved[k].accumulated.counts.removed;
    for (std::size_t bit = 0; bit < report.rejected.size(); ++bit)
      report.rejected[bit] += resolved[k].accumulated.counts.rejected[bit];
    report.opacity_held += source.presents[k].opacity_held;
    if (source.presents[k].companions.empty()) continue;
    report.companions_not_finite += source.presents[k].companions_not_finite;
    if (single[k] &&
        !resolved[k].accumulated.history.empty())  // what several colors were made of adds up to none of them
      report.lights = report.lights + measure_light_sum(source.presents[k], resolved[k].accumulated.history, workers);
  }
}

/// What to render again, beside all samples that are there.
RerenderList list_renders(const Setup& s, RerenderSurvey survey) {
  for (const auto& [frame, crops] : s.extras.frames)
    for (const ExtraCrop& crop : crops)
      if (crop.jitter) survey.positions[frame].emplace_back(crop.jitter->x, crop.jitter->y);
  return make_rerender_list(std::move(survey.frames), survey.display, s.job.rerender, survey.positions);
}

/// Each kind of remark once: the numbers in it differ from frame to frame.
void tell_of_cameras(const SourceFrame& source, std::set<std::string>& told, const ResolveEvents& events) {
  const std::string& remark = source.by_camera.remark;
  if (remark.empty() || !events.warning || !told.insert(remark.substr(0, remark.find('('))).second) return;
  events.warning("frame " + std::to_string(source.headers.frame) + ": " + remark);
}

/// Once a run.
void tell_of_half_vectors(const SourceFrame& source, std::set<std::string>& told, const ResolveEvents& events,
                          Workers& workers) {
  if (!events.warning || told.contains("half")) return;
  const std::string remark = half_vectors_remark(source, workers);
  if (remark.empty()) return;
  told.insert("half");
  events.warning("frame " + std::to_string(source.headers.frame) + ": " + remark);
}

}  // namespace

Plan plan_sequence(const ResolveJob& asked, SequenceInfo& info) {
  const SettledLayers ordered = settle_layers(asked);
  const ResolveJob& job = ordered.job;
  Setup s = set_up(ordered);
  check_outputs(job, schedule_frames(job, s.info));
  info = std::move(s.info);
  return std::move(s.plan);
}

ResolveSummary resolve_sequence(const ResolveJob& asked, const ResolveEvents& events) {
  ResolveSummary summary;
  const auto stop = [&] { return summary.stopped = summary.stopped || (events.should_stop && events.should_stop()); };
  wait_for_frames(asked, events.waiting, stop);
  if (summary.stopped) return summary;

  // Probe and plan: headers only, unless depth says which layer is in front, or pixels what the vectors mean.
  const SettledVectors settled = settle_vectors(asked);
  const SettledLayers ordered = settle_layers(settled.job);
  const ResolveJob& job = ordered.job;
  Setup s = set_up(ordered);
  if (!settled.note.empty()) s.plan.notes.push_back(settled.note);
  if (!settled.note.empty() && events.warning) events.warning(settled.note);
  if (events.planned) events.planned(s.info, s.plan);

  for (const std::string& warning : s.extras.warnings)
    if (events.warning) events.warning(warning);

  // Preflight: what will be written, and whether it can be.
  Workers workers(job.threads);
  const StateHead* before = s.before ? &*s.before : nullptr;
  std::vector<ScheduledFrame> schedule = schedule_frames(job, s.info, before);
  check_outputs(job, schedule);
  if (events.checked) events.checked(s.parameters, s.hash);
  for (const std::string& folder : output_folders(job)) remove_leftovers(folder);
  if (job.find_cuts) schedule = schedule_frames(job, s.info, before, look_for_cuts(s, events, stop, workers));
  InputWatch watch{job.input, s.extras};
  mark_finished(s, watch, schedule);

  if (job.check_motion && s.plan.use_motion) check_vectors(job, s.info, events.warning, workers);
  std::vector<SubjectState> states(accumulated_subjects(s.info.first.outputs, s.info.first.subjects).size());
  if (before) states = continued_states(s, watch);
  std::set<std::string> told;
  const bool four = job.parameters.accumulator == Accumulator::subpixel;
  const bool recursive = four || job.parameters.accumulator == Accumulator::recursive;
  CameraTrack camera_track = s.info.cameras;
  if (before) camera_track.emplace(before->last(), before->cameras);
  const SourceOptions source_options{s.job,
                                     s.info,
                                     s.plan,
                                     s.jitter,
                                     s.cameras,
                                     camera_track,
                                     s.extras,
                                     s.into_working_space ? &*s.into_working_space : nullptr,
                                     s.reach.back_to_restart,
                                     shows_combined(s.aovs)};
  const auto read = [&](std::size_t index) {
    SourceFrame source = read_unchanged(watch, schedule[index].frame, [&] {
      return read_source_frame(source_options, schedule[index].frame, neighbors_of(schedule, index), workers);
    });
    if (before && index == 0) continue_cameras(source, before->cameras, states);
    tell_of_half_vectors(source, told, events, workers);
    for (std::size_t k = 0; recursive && k < source.presents.size(); ++k) {
      if (schedule[index].restart) states[k].forward = {};
      source.repairs.push_back(follow_motion(source.presents[k], cameras_of(source, k), job.parameters.motion,
                                             job.parameters.repair, states[k].forward, workers));
    }
    return source;
  };
  FrameWindow window(read);
  int total = 0, done = 0;
  for (const ScheduledFrame& scheduled : schedule) total += scheduled.write;

  const auto blur_table =
      four ? blur_table_for(job.parameters.subpixel, job.parameters.recursive) : std::optional<BlurTable>();
  const AccumulatorOptions accumulator{job.parameters, s.gather, s.measured, blur_table};
  const bool gathers = job.parameters.accumulator == Accumulator::gather;
  std::optional<TwoSidedPass> two_sided;
  if (job.parameters.accumulator == Accumulator::two_sided)
    two_sided.emplace(schedule, s.reach, StepOptions{job.parameters, diagnostics_wanted(s.measured)},
                      job.request.spill_folder, read, stop, workers);

  RerenderSurvey survey;
  const Aov* const evaluation = find_aov("evaluation");
  const bool evaluates = std::find(s.measured.begin(), s.measured.end(), evaluation) != s.measured.end();
  for (std::size_t i = 0; i < schedule.size() && !stop(); ++i) {
    ScheduledFrame& scheduled = schedule[i];
    if (!scheduled.write && !s.reach.back_to_restart) continue;  // there for its neighbors only
    FrameReport report;
    report.frame = scheduled.frame;
    report.restart = scheduled.restart_reason;
    if (scheduled.write) report.path = job.output.path(scheduled.frame);
    if (events.warning && scheduled.restart && scheduled.restart_reason.starts_with("gap"))
      events.warning("frame " + std::to_string(scheduled.frame) + ": " + scheduled.restart_reason +
                     "; its vectors lead to a frame that is not there, so the history starts anew");

    if (!is_needed(schedule, i, s.reach)) {
      report.skipped = scheduled.complete;
      summary.frames_skipped += scheduled.complete;
      if (events.frame) events.frame(report, scheduled.write ? ++done : done, total);
      continue;
    }

    // Read what is not held yet.
    Stopwatch clock;
    const bool one_frame = s.reach.back_to_restart || two_sided;
    const auto [first, last] = one_frame ? std::pair(i, i) : span_around(schedule, i, s.reach);
    window.hold(first, last);
    SourceFrame& source = window[i];
    report.read_seconds = clock.lap();
    if (stop()) break;
    tell_of_cameras(source, told, events);

    // Resolve, subject by subject.
    std::vector<Resolved> resolved = two_sided ? accumulate_two_sided(*two_sided, i, source)
                                     : gathers
                                         ? accumulate_gather(accumulator, window, i, {first, last}, states, workers)
                                     : four ? accumulate_subpixel_frame(accumulator, source, scheduled, states, workers)
                                            : accumulate_recursive(accumulator, source, scheduled, states, workers);
    if (summary.stopped) break;
    hold_layers(source, resolved, workers);
    count(report, source, resolved, workers);
    const bool writes = scheduled.write && !scheduled.complete;
    ResolvedColors written = writes ? colors_to_write(s, source, resolved, workers) : ResolvedColors();
    const std::deque<Evaluation> evaluations =
        evaluates ? evaluate_colors(source, written.colors, job.rerender, survey, workers) : std::deque<Evaluation>();
    report.resolve_seconds = clock.lap();
    if (stop()) break;

    // Write, and remember.
    if (writes) {
      const FileSet beside = source.pixels.empty() ? read_beside(s, source.headers, workers) : FileSet();
      const FileSet& pixels = source.pixels.empty() ? beside : source.pixels;
      in_frame(scheduled.frame, [&] {
        const Provenance provenance = provenance_of(frames_used(schedule, i, s.reach, before, watch),
                                                    extras_used(s.extras, schedule, i, s.reach));
        const auto check = [&] { check_unchanged(watch, scheduled.frame); };
        report.half_overflows =
            write_outputs(s, report.path, source.headers, pixels, written.colors, provenance, check, workers);
      });
      report.write_seconds = clock.lap();
      report.written = true;
      ++summary.frames_written;
    }
    report.skipped = scheduled.complete;
    summary.frames_skipped += scheduled.complete;
    for (std::size_t k = 0; k < resolved.size(); ++k) states[k].history = std::move(resolved[k].accumulated.history);
    if (scheduled.leaves_state)
      save_states(s, source.headers, frames_used(schedule, i, s.reach, before, watch), states);
    if (events.frame) events.frame(report, scheduled.write ? ++done : done, total);
  }
  if (!job.rerender.files.empty() && !summary.stopped) summary.rerender = list_renders(s, std::move(survey));
  return summary;
}

}  // namespace varve
