#include "exr/jitter_list.h"

#include <algorithm>

#include "base/error.h"
#include "base/json.h"
#include "exr/jitter.h"

namespace varve {
namespace {

/// Converted, and never "-0": a list that differs from another by a sign alone would only puzzle.
Jitter converted(const JitterListJob& job, const JitterList& list, Jitter jitter) {
  const Jitter out = list.convention->convert(jitter, double(job.width), double(job.height));
  return {out.x + 0.0, out.y + 0.0};
}

std::string pair_text(Jitter jitter) { return json_number(jitter.x) + "," + json_number(jitter.y); }

std::string points_text(const JitterList& list) {
  return std::to_string(list.points.size()) + (list.points.size() == 1 ? " point" : " points");
}

}  // namespace

JitterList list_jitter(const JitterListJob& job) {
  const std::optional<NamedPattern> named = parse_pattern(job.pattern);
  if (!named)
    throw Failure(ExitCode::usage, "there is no jitter pattern \"" + job.pattern.substr(0, job.pattern.find(':')) +
                                       "\"; there are " + jitter_pattern_names());
  JitterList list;
  list.name = named->pattern->name;
  const PatternRequest request{named->length > 0 ? named->length : job.count, std::uint64_t(job.seed), job.direction};
  if (named->pattern->length == 0 && request.length > named->pattern->most)
    throw Failure(ExitCode::usage, list.name + " has up to " + std::to_string(named->pattern->most) +
                                       " points; for more frames give it a length, such as " + list.name + ":64");
  list.points = named->pattern->points(request);
  for (Jitter& p : list.points) p.x *= job.amplitude, p.y *= job.amplitude;
  list.centroid = centroid_of(list.points);
  if (job.centered)
    for (Jitter& p : list.points) p.x -= list.centroid.x, p.y -= list.centroid.y;
  const auto conventions = jitter_conventions();
  const auto row = std::ranges::find(conventions, job.convention, &JitterConvention::name);
  list.convention = row == conventions.end() ? &conventions.front() : &*row;
  if (list.convention->needs_size && (job.width < 1 || job.height < 1))
    throw Failure(ExitCode::usage, "the convention " + std::string(list.convention->name) +
                                       " needs the size of the picture; give --size, such as --size 1920x1080");
  return list;
}

std::string jitter_csv(const JitterListJob& job, const JitterList& list) {
  const JitterConvention& convention = *list.convention;
  std::string text = "# pattern " + list.name + ", " + points_text(list) + ", frame 1 is the first\n";
  if (job.seed != 0) text += "# seed " + std::to_string(job.seed) + "\n";
  if (job.direction != 0) text += "# direction " + json_number(job.direction) + " degrees\n";
  if (job.amplitude != 1) text += "# amplitude " + json_number(job.amplitude) + "\n";
  text += "# convention " + std::string(convention.name);
  text += convention.needs_size
              ? " for " + std::to_string(job.width) + "x" + std::to_string(job.height) + " pixels; not read by varve\n"
              : ": sample position minus pixel center, pixels, x right, y down\n";
  text += "# centroid " + pair_text(list.centroid) + " pixels" + (job.centered ? ", subtracted" : "") + "\n";
  text += "frame," + std::string(convention.x) + "," + std::string(convention.y) + "\n";
  for (int i = 0; i < job.count; ++i)
    text += std::to_string(job.first + i) + "," +
            pair_text(converted(job, list, pattern_point(list.points, job.first + i))) + "\n";
  return text;
}

std::string jitter_json(const JitterListJob& job, const JitterList& list) {
  std::string text = "{\"pattern\":" + json_quote(list.name) + ",\"length\":" + std::to_string(list.points.size()) +
                     ",\"convention\":" + json_quote(list.convention->name) + ",\"seed\":" + std::to_string(job.seed) +
                     ",\"direction\":" + json_number(job.direction) + ",\"amplitude\":" + json_number(job.amplitude) +
                     ",\"centroid\":[" + pair_text(list.centroid) +
                     "],\"centered\":" + (job.centered ? "true" : "false") + ",\"frames\":[";
  for (int i = 0; i < job.count; ++i) {
    const Jitter p = converted(job, list, pattern_point(list.points, job.first + i));
    text += std::string(i > 0 ? "," : "") + "\n{\"frame\":" + std::to_string(job.first + i) + "," +
            json_quote(list.convention->x) + ":" + json_number(p.x) + "," + json_quote(list.convention->y) + ":" +
            json_number(p.y) + "}";
  }
  return text + "\n]}\n";
}

}  // namespace varve
