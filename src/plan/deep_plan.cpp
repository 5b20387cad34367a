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

}  // namespace

std::optional<PlannedPass> flatten_pass(const SequenceInfo& info) {
  const FileHeader& file = info.first.files.front();
  if (std::none_of(file.parts.begin(), file.parts.end(), is_deep)) return std::nullopt;
  const std::set<int> colors = deep_colors(info);
  if (colors.empty()) return PlannedPass{"flatten", false, "no deep part is resolved; they are copied as they are"};
  bool volumes = false;
  for (const int part : colors) volumes = volumes || deep_channels(file.parts[std::size_t(part)]).z_back.has_value();
  return PlannedPass{"flatten", true,
                     std::string("the color is deep: samples are sorted") +
                         (volumes ? ", volumes split where they overlap," : "") +
                         " and composited front to back; the rest sees a flat picture"};
}

std::string deep_text(const LayersRequest& request, const SequenceInfo& info) {
  if (deep_colors(info).empty()) return "";
  return request.rule == LayerRule::variation ? " deep-rule=variation" : " deep-rule=contribution";
}

std::size_t deep_bytes(const SequenceInfo& info) {
  // Deflate gains about a factor of two on samples; a chunk at work takes three times its unpacked size.
  return std::size_t(std::min(double(DeepLimits{}.band_bytes), 6 * packed_bytes(info)));
}

double deep_nanoseconds(const SequenceInfo& info) {
  constexpr double kPerPackedByte = 20;
  return packed_bytes(info) * kPerPackedByte;
}

}  // namespace varve
