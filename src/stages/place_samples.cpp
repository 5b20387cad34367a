#include "stages/place_samples.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "exr/convert.h"
#include "exr/sample_names.h"

namespace varve {
namespace {

/// The part's name without the number of a sample. A part among others needs a name.
std::string name_without_number(const std::string& stem, const std::vector<OutputPart>& parts,
                                const FileHeader& source) {
  if (parts.size() == 1 || !stem.empty()) return stem;
  const auto taken = [&](const OutputPart& part) { return source.parts[std::size_t(part.source_part)].name == "rgba"; };
  return std::any_of(parts.begin(), parts.end(), taken) ? "resolved" : "rgba";
}

}  // namespace

void divide_around(RawPlane& plane, double bias, double by, Workers& workers) {
  if (plane.empty() || plane.type == PixelType::uint32) return;
  const auto count = static_cast<std::size_t>(plane.columns);
  workers.for_rows(0, plane.rows, [&](int y) {
    std::vector<float> row(count);
    to_float(plane.type, plane.row(y), row.data(), count);
    for (float& v : row) v = float(bias + (double(v) - bias) / by);
    if (plane.type == PixelType::float16)
      to_half_clamped(row.data(), reinterpret_cast<std::uint16_t*>(plane.row(y)), count);
    else
      std::memcpy(plane.row(y), row.data(), count * sizeof(float));
  });
}

void divide_passed_vectors(const FrameHeaders& headers, FramePixels& pixels, Workers& workers) {
  if (headers.grid == 1) return;
  std::vector<ChannelRef> done;
  const auto once = [&](ChannelRef ref) {
    if (ref.file != 0 || std::find(done.begin(), done.end(), ref) != done.end()) return false;
    done.push_back(ref);
    return true;
  };
  for (const ColorOutput& output : headers.outputs)
    for (const auto& [vectors, encoding] : {std::pair{output.subject.backward, output.subject.backward_encoding},
                                            std::pair{output.subject.forward, output.subject.forward_encoding}})
      for (std::size_t axis = 0; vectors && encoding.unit == MotionUnit::pixel && axis < 2; ++axis)
        if (const ChannelRef ref = (*vectors)[axis]; once(ref))
          divide_around(pixels.planes[std::size_t(ref.part)][std::size_t(ref.channel)], encoding.bias, headers.grid,
                        workers);
}

void place_samples(const FrameHeaders& headers, std::vector<OutputPart>& parts) {
  if (headers.sample_jitter.empty()) return;
  const FileHeader& shown = headers.files.front();
  for (OutputPart& part : parts) {
    const Part& source = shown.parts[std::size_t(part.source_part)];
    if (part.copy_chunks) continue;
    part.without.push_back("jitter");
    if (headers.grid == 1) {
      if (const auto sample = parse_sample_name(source.name))
        part.name = name_without_number(sample->stem, parts, shown);
    } else {
      part.windows = {source.data_window, source.display_window};
      part.source_part %= int(headers.stored.front().parts.size());
    }
  }
}

}  // namespace varve
