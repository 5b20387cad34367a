#include "stages/half_vectors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "plan/value.h"

namespace varve {
namespace {

/// Name of the first vector channel that is stored as half; "" if there is none.
std::string half_channel(const FrameHeaders& headers) {
  for (const Subject& subject : headers.subjects)
    for (const std::optional<VectorChannels>& vector : {subject.backward, subject.forward}) {
      if (!vector) continue;
      const ChannelRef ref = (*vector)[0];
      const Channel& channel =
          headers.files[std::size_t(ref.file)].parts[std::size_t(ref.part)].channels[std::size_t(ref.channel)];
      if (channel.type == PixelType::float16) return channel.name;
    }
  return "";
}

/// Length of the longest usable vector.
double longest_of(const Plane<glm::vec2>& motion, Workers& workers) {
  if (motion.empty()) return 0;
  const Window& w = motion.window();
  std::vector<double> longest(std::size_t(w.height()), 0.0);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    double most = 0;
    for (int x = 0; x < w.width(); ++x) {
      const glm::dvec2 v(motion.row(y)[x]);
      const double squared = v.x * v.x + v.y * v.y;
      if (squared > most) most = squared;  // false for NaN
    }
    longest[std::size_t(y - w.y0)] = most;
  });
  return std::sqrt(*std::max_element(longest.begin(), longest.end()));
}

}  // namespace

std::string half_vectors_remark(const SourceFrame& source, Workers& workers) {
  const std::string channel = half_channel(source.headers);
  if (channel.empty()) return "";
  double longest = 0;
  for (const Present& present : source.presents)
    longest = std::max({longest, longest_of(present.motion, workers), longest_of(present.forward, workers)});
  if (!(longest > kLongForHalf)) return "";
  const double step = std::exp2(std::floor(std::log2(longest)) - 10);
  return channel + " is stored as half and vectors reach " + short_number(longest) + " px, where the step of half is " +
         short_number(step) + " px; store vectors as float";
}

}  // namespace varve
