#include "exr/sample_grid.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "base/error.h"

namespace varve {
namespace {

int divided(int edge, int n) { return edge / n; }  // of a multiple

bool in_blocks(const Window& w, int n) { return w.x0 % n == 0 && w.y0 % n == 0 && w.x1 % n == 0 && w.y1 % n == 0; }

Window of_cell(const Window& w, int n) {
  return {divided(w.x0, n), divided(w.y0, n), divided(w.x1, n), divided(w.y1, n)};
}

std::string window_text(const Window& w) {
  return std::to_string(w.x0) + "," + std::to_string(w.y0) + " to " + std::to_string(w.x1 - 1) + "," +
         std::to_string(w.y1 - 1);
}

void check_part(const FileHeader& file, const Part& part, int n) {
  const std::string where = file.path + (part.name.empty() ? "" : ", part " + part.name);
  const std::string grid = "--samples grid:" + std::to_string(n);
  if (is_deep(part))
    throw Failure(ExitCode::inconsistent,
                  where + " is deep, and " + grid + " counts flat pixels; flatten it, or leave the part out");
  for (const Channel& channel : part.channels)
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      throw Failure(ExitCode::inconsistent, where + ": the channel " + channel.name + " is subsampled, and " + grid +
                                                " needs a value at every pixel; convert the file first");
  for (const auto& [window, what] : {std::pair{part.data_window, "data"}, std::pair{part.display_window, "display"}})
    if (!in_blocks(window, n))
      throw Failure(ExitCode::inconsistent,
                    where + ": the " + what + " window " + window_text(window) + " is not made of whole blocks of " +
                        std::to_string(n) + "x" + std::to_string(n) + " pixels counted from 0,0; crop or pad it to " +
                        "multiples of " + std::to_string(n) + ", or give the grid it was rendered with");
}

/// Every n-th pixel of every n-th row, from the cell's own on; bytes as they are.
RawPlane pixels_of_cell(const RawPlane& stored, const Window& window, int cell, int n, Workers& workers) {
  RawPlane plane = make_raw_plane(stored.type, window);
  const std::size_t bytes = bytes_per_pixel(stored.type);
  const int right = cell % n, down = cell / n;
  workers.for_rows(0, plane.rows, [&](int y) {
    const std::byte* from = stored.row(y * n + down) + std::size_t(right) * bytes;
    std::byte* to = plane.row(y);
    for (int x = 0; x < plane.columns; ++x)
      std::memcpy(to + std::size_t(x) * bytes, from + std::size_t(x * n) * bytes, bytes);
  });
  return plane;
}

void shift_parts(Subject& subject, std::span<const int> parts, int cell) {
  const auto shift = [&](ChannelRef& ref) { ref.part += cell * parts[std::size_t(ref.file)]; };
  const auto shift_if = [&](std::optional<ChannelRef>& ref) {
    if (ref) shift(*ref);
  };
  for (auto& channel : subject.color) shift_if(channel);
  for (Companion& companion : subject.companions)
    for (auto& channel : companion.channels) shift_if(channel);
  shift_if(subject.depth);
  shift_if(subject.id);
  shift_if(subject.reactive);
  shift_if(subject.responsive);
  if (subject.normal)
    for (ChannelRef& axis : *subject.normal) shift(axis);
  for (std::optional<VectorChannels>* vectors : {&subject.backward, &subject.forward})
    if (*vectors)
      for (ChannelRef& axis : **vectors) shift(axis);
  subject.place.part += cell * parts.front();
}

}  // namespace

FileHeader header_of_cell(const FileHeader& stored, int n) {
  FileHeader cell = stored;
  for (Part& part : cell.parts) {
    check_part(stored, part, n);
    part.data_window = of_cell(part.data_window, n);
    part.display_window = of_cell(part.display_window, n);
  }
  return cell;
}

FileHeader header_of_cells(const FileHeader& cell, int n) {
  FileHeader cells = cell;
  cells.parts.clear();
  for (int c = 0; c < n * n; ++c) cells.parts.insert(cells.parts.end(), cell.parts.begin(), cell.parts.end());
  return cells;
}

std::vector<Subject> subjects_of_cells(std::span<const Subject> subjects, std::span<const int> parts, int n) {
  std::vector<Subject> all;
  for (int cell = 0; cell < n * n; ++cell)
    for (const Subject& subject : subjects) {
      Subject& s = all.emplace_back(subject);
      shift_parts(s, parts, cell);
      if (cell > 0) s.notes.clear();
      // Fractions of the display window stay what they are.
      for (MotionEncoding* encoding : {&s.backward_encoding, &s.forward_encoding})
        if (encoding->unit == MotionUnit::pixel) encoding->scale /= n;
    }
  return all;
}

Jitter jitter_of_cell(const std::optional<Jitter>& stored, int cell, int n) {
  const Jitter in_pixel = stored.value_or(Jitter{});
  return {(cell % n + 0.5 + in_pixel.x) / n - 0.5, (cell / n + 0.5 + in_pixel.y) / n - 0.5};
}

FramePixels read_cells(const FileHeader& stored, const FileHeader& cells, std::span<const ChannelRef> channels, int n,
                       Workers& workers) {
  const int parts = int(stored.parts.size());
  std::vector<ChannelRef> once;
  for (const ChannelRef& ref : channels) {
    const ChannelRef in_file{ref.file, ref.part % parts, ref.channel};
    if (std::find(once.begin(), once.end(), in_file) == once.end()) once.push_back(in_file);
  }
  const FramePixels whole = read_channels(stored, once, workers);
  FramePixels split;
  for (const Part& part : cells.parts) split.planes.emplace_back(part.channels.size());
  for (const ChannelRef& ref : channels) {
    const RawPlane& plane = whole[{ref.file, ref.part % parts, ref.channel}];
    split.planes[std::size_t(ref.part)][std::size_t(ref.channel)] =
        pixels_of_cell(plane, cells.parts[std::size_t(ref.part)].data_window, ref.part / parts, n, workers);
  }
  return split;
}

}  // namespace varve
