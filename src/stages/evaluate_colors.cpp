#include "stages/evaluate_colors.h"

namespace varve {
namespace {

void add_frame(const SourceFrame& source, const Evaluation& evaluation, const RerenderRequest& request,
               RerenderSurvey& survey) {
  const FrameHeaders& headers = source.headers;
  const int part = headers.outputs.front().subject.place.part;
  survey.display = headers.files.front().parts[std::size_t(part)].display_window;
  survey.frames.push_back(sum_tiles(headers.frame, evaluation, request));
  std::vector<glm::dvec2>& positions = survey.positions[headers.frame];
  const auto add = [&](const std::optional<Jitter>& jitter) {
    if (jitter) positions.emplace_back(jitter->x, jitter->y);
  };
  for (const std::size_t input : headers.outputs.front().inputs) add(jitter_of_subject(headers, input));
}

}  // namespace

std::deque<Evaluation> evaluate_colors(const SourceFrame& source, std::vector<ResolvedSubject>& colors,
                                       const RerenderRequest& request, RerenderSurvey& survey, Workers& workers) {
  std::deque<Evaluation> all;
  for (ResolvedSubject& color : colors)
    color.lacking = &all.emplace_back(evaluate(*color.present, *color.accumulated, request, workers)).lacking;
  if (!request.files.empty() && !all.empty()) add_frame(source, all.front(), request, survey);
  return all;
}

}  // namespace varve
