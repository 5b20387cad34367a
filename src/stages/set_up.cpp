#include "stages/set_up.h"

#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "stages/check_jitter.h"
#include "stages/continue_history.h"

namespace varve {

Setup set_up(const SettledLayers& ordered) {
  const ResolveJob& job = ordered.job;
  check_state_options(job);
  JitterSource jitter = parse_jitter_source(job.jitter);
  if (jitter.kind == JitterSource::Kind::pixels) {
    Workers workers(job.threads);
    jitter = measured_jitter(job, workers);
  }
  CameraSource cameras = parse_camera_source(job.camera);
  SequenceInfo info = probe_sequence(job.input, job.frames, job.roles, jitter, cameras);
  // A chunk of one frame has a history all the same.
  info.frames_beside = !job.state_in.empty() || frames_in_reach(job, info).size() > 1;
  check_roles(job, info);
  Plan plan = make_plan(info, job.parameters, job.request, job.threads);
  if (job.find_cuts)
    plan.passes.push_back(
        {"find cuts", true, "before all else, color and vectors of every frame within reach are read once more"});
  if (!ordered.note.empty()) plan.notes.push_back(ordered.note);
  Setup s{job,
          std::move(info),
          std::move(plan),
          jitter,
          std::move(cameras),
          {},
          {},
          reach_of(job),
          job.parameters.gather,
          planned_aovs(job.request, job.parameters.accumulator),
          {},
          {},
          {},
          {},
          {},
          {}};
  s.measured = s.aovs;
  if (!job.rerender.files.empty()) s.measured.push_back(find_aov("evaluation"));
  s.extras = find_extra_samples(job, s.info, s.jitter, frames_in_reach(job, s.info));
  s.plan.notes.insert(s.plan.notes.end(), s.extras.notes.begin(), s.extras.notes.end());
  s.gather.filter = job.parameters.recursive.sample_filter;
  s.gather.return_tolerance = job.parameters.two_sided.return_tolerance;
  if (!job.state_in.empty()) s.before = read_state_head(job.state_in);
  s.parameters = describe_parameters(job, s.info, s.before ? &*s.before : nullptr);
  s.hash = hash_of(s.parameters + describe_side_inputs(job));
  if (s.before) {
    check_continues(s);
    s.plan.passes.push_back(
        {"state", true, "the history goes on from frame " + std::to_string(s.before->last()) + " of an earlier run"});
  }
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

}  // namespace varve
