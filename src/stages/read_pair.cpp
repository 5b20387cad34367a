#include "stages/read_pair.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "exr/convert.h"

namespace varve {
namespace {

/// Headers with their subjects. A file that holds no color may still have channels to compare, and vectors whose
/// convention nothing tells are no reason to refuse a comparison.
FrameHeaders read_side(const SequencePattern& pattern, const CompareJob& job, RoleRequest roles, int frame, bool motion,
                       std::string& note) {
  InputSequence input{pattern, {}};
  if (motion && job.motion) input.roles.push_back(*job.motion);
  JitterSource none;
  none.kind = JitterSource::Kind::none;
  const bool wants_color = std::ranges::any_of(job.channels, [](const std::string& c) { return c == "color"; });
  if (!motion) roles.convention = "none";
  try {
    return read_frame_headers(input, frame, roles, none);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::inconsistent) throw;
    note = failure.what();
  }
  roles.convention = "none";
  try {
    return read_frame_headers(input, frame, roles, none);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::inconsistent || wants_color) throw;
    FrameHeaders headers;
    headers.frame = frame;
    headers.files.push_back(read_header(pattern.path(frame)));
    return headers;
  }
}

void add(std::vector<ChannelRef>& wanted, ChannelRef ref) {
  if (std::ranges::find(wanted, ref) == wanted.end()) wanted.push_back(ref);
}

FileSet read_files(const FrameHeaders& headers, const std::vector<ChannelRef>& wanted, Workers& workers) {
  FileSet files;
  for (int f = 0; f < int(headers.files.size()); ++f) {
    std::vector<ChannelRef> here;
    for (ChannelRef ref : wanted)
      if (ref.file == f) here.push_back(ref);
    files.push_back(read_channels(headers.files[std::size_t(f)], here, workers));
  }
  return files;
}

const RawPlane& raw_of(const FileSet& files, ChannelRef ref) { return files[std::size_t(ref.file)][ref]; }

/// `count` values from column `first` of a row, in double: exact for every stored type.
void row_values(const RawPlane& raw, int row, int first, std::vector<double>& out, std::vector<float>& scratch) {
  const std::byte* from = raw.row(row) + std::size_t(first) * bytes_per_pixel(raw.type);
  if (raw.type == PixelType::uint32) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      std::uint32_t value;
      std::memcpy(&value, from + 4 * i, 4);
      out[i] = value;
    }
    return;
  }
  scratch.resize(out.size());
  to_float(raw.type, from, scratch.data(), out.size());
  std::copy(scratch.begin(), scratch.end(), out.begin());
}

Plane<glm::vec4> color_plane(const Subject& subject, const FileSet& files, const Window& window, Workers& workers) {
  Plane<glm::vec4> color(window);
  std::array<std::optional<ChannelRef>, 4> refs = subject.color;
  const auto colors = std::count_if(refs.begin(), refs.begin() + 3, [](const auto& ref) { return ref.has_value(); });
  if (colors == 1) {
    const auto only = *std::find_if(refs.begin(), refs.begin() + 3, [](const auto& ref) { return ref.has_value(); });
    refs[0] = refs[1] = refs[2] = only;
  }
  workers.for_rows(window.y0, window.y1, [&](int y) {
    std::vector<float> values(std::size_t(window.width()));
    for (int k = 0; k < 4; ++k) {
      if (const auto& ref = refs[std::size_t(k)]) {
        const RawPlane& raw = raw_of(files, *ref);
        to_float(raw.type,
                 raw.row(y - raw.window.y0) + std::size_t(window.x0 - raw.window.x0) * bytes_per_pixel(raw.type),
                 values.data(), values.size());
      } else {
        std::ranges::fill(values, k == 3 ? 1.f : 0.f);
      }
      for (std::size_t x = 0; x < values.size(); ++x) color.row(y)[x][k] = values[x];
    }
  });
  return color;
}

}  // namespace

FramePair read_frame_pair(const CompareJob& job, int frame, bool motion) {
  FramePair pair;
  std::string note_a, note_b;
  pair.a = read_side(job.a, job, job.roles_a, frame, motion, note_a);
  pair.b = read_side(job.b, job, job.roles_b, frame, motion, note_b);
  pair.match = match_channels(pair.a, pair.b, job);
  for (const std::string& note : {note_a, note_b})
    if (!note.empty()) pair.match.findings.push_back({note, FindingKind::note});
  if (job.attributes)
    for (Finding& finding : compare_attributes(pair.a.files.front(), pair.b.files.front()))
      pair.match.findings.push_back(std::move(finding));
  return pair;
}

PairPixels read_pixels(const FramePair& pair, Workers& workers) {
  std::vector<ChannelRef> a, b;
  for (const ChannelPair& channel : pair.match.channels) add(a, channel.a), add(b, channel.b);
  for (const SubjectPair& subject : pair.match.subjects) {
    const Subject &sa = pair.a.subjects[subject.a], &sb = pair.b.subjects[subject.b];
    for (std::size_t k = 0; k < 4; ++k) {
      if (sa.color[k]) add(a, *sa.color[k]);
      if (sb.color[k]) add(b, *sb.color[k]);
    }
    if (const auto& vectors = sb.backward)
      for (ChannelRef ref : *vectors) add(b, ref);
    else if (const auto& others = sa.backward)
      for (ChannelRef ref : *others) add(a, ref);
  }
  PairPixels pixels;
  pixels.a = read_files(pair.a, a, workers);
  pixels.b = read_files(pair.b, b, workers);
  return pixels;
}

ChannelDifference compare_channel(const ChannelPair& channel, const PairPixels& pixels, bool nan_equal,
                                  Workers& workers) {
  const RawPlane &a = raw_of(pixels.a, channel.a), &b = raw_of(pixels.b, channel.b);
  const Window& w = channel.window;
  const bool sampled = a.x_sampling != 1 || a.y_sampling != 1;  // then both have the same window and sampling
  const int rows = sampled ? a.rows : w.height(), columns = sampled ? a.columns : w.width();
  const int left_a = sampled ? 0 : w.x0 - a.window.x0, top_a = sampled ? 0 : w.y0 - a.window.y0;
  const int left_b = sampled ? 0 : w.x0 - b.window.x0, top_b = sampled ? 0 : w.y0 - b.window.y0;
  std::vector<ChannelDifference> sums(static_cast<std::size_t>(rows));
  workers.for_rows(0, rows, [&](int y) {
    std::vector<double> va(static_cast<std::size_t>(columns)), vb(va.size());
    std::vector<float> scratch;
    row_values(a, y + top_a, left_a, va, scratch);
    row_values(b, y + top_b, left_b, vb, scratch);
    sums[std::size_t(y)] = difference_of(va, vb, nan_equal);
  });
  ChannelDifference total;
  for (const ChannelDifference& row : sums) total += row;
  return total;
}

ColorPair color_pair(const FramePair& pair, const SubjectPair& subject, const PairPixels& pixels, bool nan_equal,
                     Workers& workers) {
  return make_color_pair(color_plane(pair.a.subjects[subject.a], pixels.a, subject.window, workers),
                         color_plane(pair.b.subjects[subject.b], pixels.b, subject.window, workers), nan_equal,
                         workers);
}

Plane<glm::vec2> pair_motion(const FramePair& pair, const SubjectPair& subject, const PairPixels& pixels,
                             Workers& workers) {
  const auto decode = [&](const FrameHeaders& headers, const Subject& s, const FileSet& files) {
    std::size_t unusable = 0;
    const Window& display = headers.files.front().parts[std::size_t(part_of(s))].display_window;
    return read_vectors(*s.backward, s.backward_encoding, files, subject.window, display, MotionParameters().max_length,
                        unusable, workers);
  };
  const Subject &a = pair.a.subjects[subject.a], &b = pair.b.subjects[subject.b];
  if (b.backward) return decode(pair.b, b, pixels.b);
  if (a.backward) return decode(pair.a, a, pixels.a);
  return {};
}

}  // namespace varve
