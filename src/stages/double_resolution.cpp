#include "stages/double_resolution.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "stages/place_samples.h"

namespace varve {
namespace {

Window doubled(const Window& w) { return {2 * w.x0, 2 * w.y0, 2 * w.x1, 2 * w.y1}; }

/// A channel of the frame whose numbers are lengths in pixels.
struct PixelVectors {
  ChannelRef channel;
  double bias = 0;  ///< what is stored where nothing moves
};

std::vector<PixelVectors> find_pixel_vectors(const FrameHeaders& headers) {
  std::vector<PixelVectors> all;
  const auto add = [&](const Subject& subject) {
    for (const auto& [vectors, encoding] :
         {std::pair{subject.backward, subject.backward_encoding}, std::pair{subject.forward, subject.forward_encoding}})
      for (std::size_t axis = 0; vectors && encoding.unit == MotionUnit::pixel && axis < 2; ++axis) {
        const ChannelRef ref = (*vectors)[axis];
        const auto same = [&](const PixelVectors& v) { return v.channel == ref; };
        if (ref.file == 0 && std::none_of(all.begin(), all.end(), same)) all.push_back({ref, encoding.bias});
      }
  };
  for (const Subject& subject : headers.subjects) add(subject);
  for (const ColorOutput& output : headers.outputs) add(output.subject);
  return all;
}

/// A row into every other pixel of one twice as long, bit for bit.
template <class Bits>
void place_row(const std::byte* from, std::byte* to, bool right, int columns) {
  const auto* row = reinterpret_cast<const Bits*>(from);
  auto* out = reinterpret_cast<Bits*>(to) + right;
  for (int x = 0; x < columns; ++x) out[2 * x] = row[x];
}

/// Four planes of one size side by side, in the order of kQuadrantMiddle.
RawPlane interleave(const std::array<const RawPlane*, kQuadrants>& from, Workers& workers) {
  const RawPlane& first = *from.front();
  RawPlane to{first.type, doubled(first.window), first.x_sampling, first.y_sampling, 2 * first.columns, 2 * first.rows,
              {}};
  to.storage = Plane<std::byte>(Window{0, 0, int(std::size_t(to.columns) * bytes_per_pixel(first.type)), to.rows});
  workers.for_rows(0, first.rows, [&](int y) {
    for (std::size_t k = 0; k < kQuadrants; ++k) {
      const bool right = kQuadrantMiddle[k].x > 0, below = kQuadrantMiddle[k].y > 0;
      if (bytes_per_pixel(first.type) == 2)
        place_row<std::uint16_t>(from[k]->row(y), to.row(2 * y + below), right, first.columns);
      else
        place_row<std::uint32_t>(from[k]->row(y), to.row(2 * y + below), right, first.columns);
    }
  });
  return to;
}

/// Makes the parts, with the planes that they point to in `out`.
struct Doubling {
  const FrameHeaders& headers;
  const FramePixels& pixels;
  const std::vector<PixelVectors> vectors;
  FileOutput& out;
  Workers& workers;

  const Part& source(const OutputPart& part) const {
    return headers.files.front().parts[std::size_t(part.source_part)];
  }

  void add(OutputPart& to, const Channel& channel, const std::array<const RawPlane*, kQuadrants>& from,
           const FramePixels& read) {
    RawPlane& plane = out.planes.emplace_back(interleave(from, workers));
    for (const PixelVectors& v : vectors) {
      const auto part = std::size_t(v.channel.part), place = std::size_t(v.channel.channel);
      if (part < read.planes.size() && place < read.planes[part].size() && from.front() == &read.planes[part][place])
        divide_around(plane, v.bias, 0.5, workers);
    }
    to.channels.push_back({channel, &plane});
  }

  /// A part without anything resolved, which would be copied.
  void repeat(OutputPart& to) {
    const FileHeader& file = headers.files.front();
    const Part& part = source(to);
    if (is_deep(part))
      throw Failure(ExitCode::inconsistent,
                    "part " + std::to_string(to.source_part) + (part.name.empty() ? "" : " '" + part.name + "'") +
                        " of '" + file.path +
                        "' is deep and not resolved: there are no pixels to repeat at --scale 2; give --keep none");
    std::vector<ChannelRef> channels;
    for (int c = 0; c < int(part.channels.size()); ++c) channels.push_back({0, to.source_part, c});
    const FramePixels read = read_channels(file, channels, workers);
    to.copy_chunks = false;
    for (const ChannelRef& ref : channels)
      add(to, part.channels[std::size_t(ref.channel)], {&read[ref], &read[ref], &read[ref], &read[ref]}, read);
  }
};

}  // namespace

FileOutput double_resolution(const FrameHeaders& headers, const FramePixels& pixels,
                             const std::vector<ResolvedSubject>& resolved, const PartsOf& parts_of, Workers& workers) {
  std::array<FileOutput, kQuadrants> quarters;
  FileOutput out;
  for (std::size_t k = 0; k < kQuadrants; ++k) {
    std::vector<ResolvedSubject> colors = resolved;
    for (ResolvedSubject& color : colors) color.shown_quarter = &color.quarters[k];
    quarters[k] = parts_of(colors);
    out.half_overflows += quarters[k].half_overflows;
  }
  Doubling doubling{headers, pixels, find_pixel_vectors(headers), out, workers};
  for (std::size_t p = 0; p < quarters.front().parts.size(); ++p) {
    OutputPart to = quarters.front().parts[p];
    const Part& source = doubling.source(to);
    to.windows = {doubled(source.data_window), doubled(source.display_window)};
    to.without.push_back("jitter");
    to.channels.clear();
    if (to.copy_chunks) doubling.repeat(to);
    const std::vector<OutputChannel>& channels = quarters.front().parts[p].channels;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      std::array<const RawPlane*, kQuadrants> from{};
      for (std::size_t k = 0; k < kQuadrants; ++k) from[k] = quarters[k].parts[p].channels[c].pixels;
      doubling.add(to, channels[c].channel, from, pixels);
    }
    out.parts.push_back(std::move(to));
  }
  return out;
}

}  // namespace varve
