#include "plan/deep_plan.h"

#include <algorithm>
#include <set>

#include "exr/deep_channels.h"
#include "exr/read_deep.h"

namespace varve {
namespace {

std::set<int> deep_colors(const SequenceInfo& info) {
  std::set<int> parts;
  for (const Subject& subject : info.first.subjects)
    for (const int part : parts_of(subject))
      if (is_deep(info.first.files.front().parts[std::size_t(part)])) parts.insert(part);
  return parts;
}

// Bytes in the file that belong to deep colors, parts taken as equally large.
double packed_bytes(const SequenceInfo& info) {
  const FileHeader& file = info.first.files.front();
  return double(file.file_bytes) * double(deep_colors(info).size()) /
         double(std::max<std::size_t>(1, file.parts.size()));
}

bool has_volumes(const SequenceInfo& info) {
  const std::set<int> parts = deep_colors(info);
  return std::any_of(parts.begin(), parts.end(), [&](int part) {
    return deep_channels(info.first.files.front().parts[std::size_t(part)]).z_back.has_value();
  });
}

}  // namespace

std::optional<PlannedPass> flatten_pass(const SequenceInfo& info) {
  const FileHeader& file = info.first.files.front();
  if (std::none_of(file.parts.begin(), file.parts.end(), is_deep)) return std::nullopt;
  if (deep_colors(info).empty())
    return PlannedPass{"flatten", false, "no deep part is resolved; they are copied as they are"};
  return PlannedPass{"flatten", true,
                     std::string("the color is deep: samples are sorted") +
                         (has_volumes(info) ? ", volumes split where they overlap," : "") +
                         " and composited front to back; the rest sees a flat picture"};
}

std::string deep_text(const LayersRequest& request, const SequenceInfo& info) {
  if (deep_colors(info).empty()) return "";
  return request.rule == LayerRule::variation ? " deep-rule=variation" : " deep-rule=contribution";
}

std::size_t deep_bytes(const SequenceInfo& info) {
  // Deflate gains about a factor of two on samples, a chunk at work takes three times its unpacked size, and each
  // thread has one: eight lines of scan-line parts.
  double lines = 1;
  for (const int part : deep_colors(info))
    lines = std::max(lines, double(info.first.files.front().parts[std::size_t(part)].data_window.height()));
  return std::size_t(std::min(double(DeepLimits{}.band_bytes), 6 * 8 * packed_bytes(info) / lines));
}

double deep_nanoseconds(const SequenceInfo& info) {
  // Measured on 1080p of 8 to 32 samples, ZIPS: 61 ns for a point, 209 ns for a volume among others that it overlaps.
  constexpr double kPoints = 9, kVolumes = 17;  // for each packed byte
  return packed_bytes(info) * (has_volumes(info) ? kVolumes : kPoints);
}

}  // namespace varve
