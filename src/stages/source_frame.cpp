#include "stages/source_frame.h"

#include <utility>

#include "stages/check_same_subjects.h"
#include "stages/combine_presents.h"
#include "stages/place_samples.h"

namespace varve {

SourceFrame read_source_frame(const SourceOptions& options, int frame, Workers& workers) {
  const Plan& plan = options.plan;
  SourceFrame source;
  source.headers = read_frame_headers(options.job.input, frame, options.job.roles, options.jitter);
  check_same_subjects(options.info.first, source.headers, plan);
  source.pixels = in_frame(frame, [&] {
    return read_files(source.headers,
                      {.depth = plan.use_depth,
                       .motion = plan.use_motion,
                       .whole_parts = options.job.request.keep_channels && options.keep_pixels,
                       .forward = plan.use_forward,
                       .id = plan.use_id,
                       .normal = plan.use_normal,
                       .reactive = plan.use_reactive,
                       .responsive = plan.use_responsive},
                      workers);
  });
  const ReadOptions read{.motion = options.job.parameters.motion,
                         .use_depth = plan.use_depth,
                         .use_motion = plan.use_motion,
                         .use_forward = plan.use_forward,
                         .use_id = plan.use_id,
                         .use_normal = plan.use_normal,
                         .use_reactive = plan.use_reactive,
                         .use_responsive = plan.use_responsive};
  std::vector<Present> presents;
  for (const Subject& subject : source.headers.subjects) {
    const Part& part = source.headers.files.front().parts[std::size_t(part_of(subject))];
    presents.push_back(read_present(subject, source.pixels, part.data_window, part.display_window, read,
                                    options.into_working_space, source.vectors_bad, workers));
    if (const auto jitter = jitter_of_subject(source.headers, presents.size() - 1))
      presents.back().jitter = glm::dvec2(jitter->x, jitter->y);
  }
  // The gather filters by itself, from true positions.
  const Parameters& p = options.job.parameters;
  const SampleFilter filter = p.accumulator == Accumulator::gather ? SampleFilter::none : p.recursive.sample_filter;
  source.presents = combine_presents(source.headers, std::move(presents),
                                     {options.job.roles, options.show_combined, filter}, workers);
  if (options.keep_pixels)
    divide_passed_vectors(source.headers, source.pixels.front(), workers);
  else
    source.pixels.clear();
  return source;
}

}  // namespace varve
