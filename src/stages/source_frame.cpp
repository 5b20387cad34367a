#include "stages/source_frame.h"

#include <utility>

#include "stages/check_same_subjects.h"
#include "stages/combine_presents.h"
#include "stages/place_samples.h"

namespace varve {
namespace {

/// What cameras have to say: planar depth, and vectors.
void use_cameras(SourceFrame& source, std::vector<Present>& presents, const SourceOptions& options,
                 const NeighborFrames& neighbors, Workers& workers) {
  const MotionParameters& motion = options.job.parameters.motion;
  for (std::size_t k = 0; k < presents.size(); ++k) {
    Present& present = presents[k];
    const CamerasAround& cameras = source.cameras[k];
    if (motion.depth_kind == DepthKind::ray && cameras.here && !present.depth.empty())
      ray_to_planar_depth(present.depth, present.jitter.value_or(glm::dvec2(0)), *cameras.here, workers);
    move_by_camera(present, source.headers.subjects[k], cameras, neighbors, motion, options.plan.use_forward,
                   source.by_camera, workers);
    if (!options.plan.use_depth) present.depth = {};  // read for the cameras only
  }
}

}  // namespace

CamerasAround cameras_of(const SourceFrame& source, std::size_t present) {
  std::size_t next = 0;
  for (const ColorOutput& output : source.headers.outputs) {
    const std::size_t place = output.after ? present - next : 0, count = output.after ? output.inputs.size() : 1;
    if (present < next + count && place < output.inputs.size() && output.inputs[place] < source.cameras.size())
      return source.cameras[output.inputs[place]];
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
  source.pixels = in_frame(frame, [&] {
    return read_files(source.headers,
                      {.depth = plan.use_depth || plan.use_cameras,
                       .motion = plan.use_motion,
                       .whole_parts = options.job.request.keep_channels && options.keep_pixels,
                       .forward = plan.use_forward,
                       .id = plan.use_id,
                       .normal = plan.use_normal,
                       .reactive = plan.use_reactive,
                       .responsive = plan.use_responsive,
                       .rule = options.job.roles.combine_layers.rule,
                       .show_combined = options.show_combined},
                      deep, workers);
  });
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
    in_frame(frame, [&] { use_cameras(source, presents, options, neighbors, workers); });
  }
  // Who takes samples at their true positions filters by itself.
  const Parameters& p = options.job.parameters;
  const SampleFilter filter = p.accumulator == Accumulator::gather || p.accumulator == Accumulator::subpixel
                                  ? SampleFilter::none
                                  : p.recursive.sample_filter;
  source.presents = combine_presents(source.headers, std::move(presents),
                                     {options.job.roles, options.show_combined, filter}, workers);
  if (options.keep_pixels)
    divide_passed_vectors(source.headers, source.pixels.front(), workers);
  else
    source.pixels.clear();
  return source;
}

}  // namespace varve
