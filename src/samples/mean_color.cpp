#include "samples/mean_color.h"

namespace varve {
namespace {

template <class At>
Plane<glm::vec4> mean_plane(Samples samples, const At& plane_of, Workers& workers) {
  const Window& w = samples.front()->color.window();
  Plane<glm::vec4> mean(w, kPresentBorder, glm::vec4(0.0f));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::dvec4 valid(0), all(0);
      int count = 0;
      for (const Present* sample : samples) {
        const glm::dvec4 color(plane_of(*sample).at(x, y));
        all += color;
        if (!(sample->valid.at(x, y) > 0)) continue;
        valid += color;
        ++count;
      }
      mean.at(x, y) = glm::vec4(count > 0 ? valid / double(count) : all / double(samples.size()));
    }
  });
  return mean;
}

}  // namespace

void mean_colors(Samples samples, Present& out, Workers& workers) {
  using Colors = Plane<glm::vec4>;
  out.color = mean_plane(
      samples, [](const Present& p) -> const Colors& { return p.color; }, workers);
  for (std::size_t k = 0; k < samples.front()->companions.size(); ++k)
    out.companions.push_back(mean_plane(
        samples, [k](const Present& p) -> const Colors& { return p.companions[k]; }, workers));
}

}  // namespace varve
