#include "stages/source_frame.h"

#include <utility>

#include "samples/add_samples.h"
#include "stages/check_same_subjects.h"
#include "stages/combine_presents.h"
#include "stages/place_samples.h"
#include "stages/read_extras.h"

namespace varve {
namespace {

/// What cameras have to say of subject `k`: planar depth, and vectors.
void use_cameras(const SourceFrame& source, Present& present, std::size_t k, const SourceOptions& options,
                 const NeighborFrames& neighbors, CameraVectors& counts, Workers& workers) {
  const MotionParameters& motion = options.job.parameters.motion;
  const CamerasAround& cameras = source.cameras[k];
  if (motion.depth_kind == DepthKind::ray && cameras.here && !present.depth.empty())
    ray_to_planar_depth(present.depth, present.jitter.value_or(glm::dvec2(0)), *cameras.here, workers);
  move_by_camera(present, source.headers.subjects[k], cameras, neighbors, motion, options.plan.use_forward, counts,
                 workers);
  if (!options.plan.use_depth) present.depth = {};  // read for the cameras only
}

/// What is read of a frame's files, besides what is only passed on.
ChannelNeeds needs_of(const SourceOptions& options) {
  const Plan& plan = options.plan;
  return {.depth = plan.use_depth || plan.use_cameras,
          .motion = plan.use_motion,
          .forward = plan.use_forward,
          .id = plan.use_id,
          .normal = plan.use_normal,
          .reactive = plan.use_reactive,
          .responsive = plan.use_responsive,
          .rule = options.job.roles.combine_layers.rule,
          .show_combined = options.show_combined};
}

}  // namespace

CamerasAround cameras_of(const SourceFrame& source, std::size_t present) {
  return cameras_of(source.headers, source.cameras, present);
}

CamerasAround cameras_of(const FrameHeaders& headers, const std::vector<CamerasAround>& cameras, std::size_t present) {
  std::size_t next = 0;
  for (const ColorOutput& output : headers.outputs) {
    const std::size_t place = output.after ? present - next : 0, count = output.after ? output.inputs.size() : 1;
    if (present < next + count && place < output.inputs.size() && output.inputs[place] < cameras.size())
      return cameras[output.inputs[place]];
    if (present < next + count) return {};
    next += count;
  }
  return {};
}

SourceFrame read_source_frame(const SourceOptions& options, int frame, const NeighborFrames& neighbors,
                              Workers& workers) {
  const Plan& plan = options.plan;
  SourceFrame source;
  source.headers = read_frame_headers(options.job.input, frame, options.job.roles, options.jitter, options.cameras);
  check_same_subjects(options.info.first, source.headers, plan);
  DeepFrame deep;
  ChannelNeeds needs = needs_of(options);
  needs.whole_parts = options.job.request.keep_channels && options.keep_pixels;
  source.pixels = in_frame(frame, [&] { return read_files(source.headers, needs, deep, workers); });
  const ReadOptions read{.motion = options.job.parameters.motion,
                         .use_depth = plan.use_depth || plan.use_cameras,
                         .use_motion = plan.use_motion,
                         .use_forward = plan.use_forward,
                         .use_id = plan.use_id,
                         .use_normal = plan.use_normal,
                         .use_reactive = plan.use_reactive,
                         .use_responsive = plan.use_responsive};
  source.deep = deep.counts;
  std::vector<Present> presents;
  for (const Subject& subject : source.headers.subjects) {
    const Part& part = source.headers.files.front().parts[std::size_t(part_of(subject))];
    presents.push_back(read_present(subject, source.pixels, part.data_window, part.display_window, read,
                                    options.into_working_space, source.vectors_bad, workers));
    if (const auto jitter = jitter_of_subject(source.headers, presents.size() - 1))
      presents.back().jitter = glm::dvec2(jitter->x, jitter->y);
    if (const auto shown = deep.combined.find(part_of(subject)); shown != deep.combined.end()) {
      CombinePlanes& combined = presents.back().combined;
      combined.winner = shown->second.winner.clone();
      combined.variation = shown->second.variation.clone();
      combined.touched = shown->second.touched.clone();
    }
  }
  if (plan.use_cameras) {
    source.cameras =
        cameras_around(source.headers, neighbors, options.job, options.jitter, options.cameras, options.camera_track);
    in_frame(frame, [&] {
      for (std::size_t k = 0; k < presents.size(); ++k)
        use_cameras(source, presents[k], k, options, neighbors, source.by_camera, workers);
    });
  }
  source.extras = in_frame(frame, [&] {
    const auto move = [&](Present& present, std::size_t subject) {
      CameraVectors not_counted;
      if (plan.use_cameras) use_cameras(source, present, subject, options, neighbors, not_counted, workers);
    };
    return read_extras(options, source.headers, presents, read, needs_of(options),
                       options.job.parameters.accumulator == Accumulator::gather, move, workers);
  });
  // Who takes samples at their true positions filters by itself, and keeps further ones apart.
  const Parameters& p = options.job.parameters;
  const bool places = p.accumulator == Accumulator::gather || p.accumulator == Accumulator::subpixel;
  const SampleFilter filter = places ? SampleFilter::none : p.recursive.sample_filter;
  source.presents = combine_presents(source.headers, std::move(presents),
                                     {options.job.roles, options.show_combined, filter}, workers);
  if (!places) {
    for (std::size_t k = 0; k < source.extras.size(); ++k)
      source.presents[k] = add_samples(std::move(source.presents[k]), source.extras[k], filter, workers);
    source.extras.clear();
  }
  if (options.keep_pixels)
    divide_passed_vectors(source.headers, source.pixels.front(), workers);
  else
    source.pixels.clear();
  return source;
}

}  // namespace varve
