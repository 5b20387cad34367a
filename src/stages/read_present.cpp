#include "stages/read_present.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "exr/convert.h"
#include "plan/find_samples.h"

namespace varve {
namespace {

const RawPlane& pixels_of(const FileSet& files, ChannelRef ref) { return files[std::size_t(ref.file)][ref]; }

/// One channel as float over `window`; where its own window has no data, `outside`.
Plane<float> read_plane(const RawPlane& raw, const Window& window, float outside, Workers& workers) {
  Plane<float> plane(window);
  const Window common = intersect(raw.window, window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    float* row = plane.row(y);
    if (y < common.y0 || y >= common.y1) {
      std::fill(row, row + window.width(), outside);
      return;
    }
    std::fill(row, row + (common.x0 - window.x0), outside);
    const std::byte* from =
        raw.row(y - raw.window.y0) + std::size_t(common.x0 - raw.window.x0) * bytes_per_pixel(raw.type);
    to_float(raw.type, from, row + (common.x0 - window.x0), std::size_t(common.width()));
    std::fill(row + (common.x1 - window.x0), row + window.width(), outside);
  });
  return plane;
}

/// RGBA, interleaved. A missing color channel is 0, a missing alpha 1.
Plane<glm::vec4> read_color(const Subject& subject, const FileSet& files, const Window& window, Workers& workers) {
  Plane<glm::vec4> color(window, kPresentBorder);
  const int width = window.width();
  workers.for_rows(window.y0, window.y1, [&](int y) {
    std::array<std::vector<float>, 4> channels;
    for (std::size_t k = 0; k < 4; ++k) {
      channels[k].assign(static_cast<std::size_t>(width), k == 3 ? 1.0f : 0.0f);
      if (const auto& ref = subject.color[k]) {
        const RawPlane& raw = pixels_of(files, *ref);
        to_float(raw.type, raw.row(y - raw.window.y0), channels[k].data(), channels[k].size());
      }
    }
    const float *r = channels[0].data(), *g = channels[1].data(), *b = channels[2].data(), *a = channels[3].data();
    glm::vec4* row = color.row(y);
    for (int x = 0; x < width; ++x) row[x] = glm::vec4(r[x], g[x], b[x], a[x]);
  });
  return color;
}

/// Identities as bits, to be compared only: integers as they are, floats by their pattern with one zero. Cryptomatte
/// stores hashes that way; halves are widened first. 0 where the channel's own window has no data.
Plane<std::uint32_t> read_id(const RawPlane& raw, const Window& window, Workers& workers) {
  Plane<std::uint32_t> id(window);
  const Window common = intersect(raw.window, window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    std::uint32_t* row = id.row(y);
    std::fill(row, row + window.width(), 0u);
    if (y < common.y0 || y >= common.y1) return;
    const std::size_t count = std::size_t(common.width());
    const std::byte* from =
        raw.row(y - raw.window.y0) + std::size_t(common.x0 - raw.window.x0) * bytes_per_pixel(raw.type);
    row += common.x0 - window.x0;
    if (raw.type == PixelType::uint32) {
      std::memcpy(row, from, count * sizeof *row);
      return;
    }
    std::vector<float> values(count);
    to_float(raw.type, from, values.data(), count);
    for (std::size_t i = 0; i < count; ++i)
      row[i] = values[i] == 0 ? 0u : std::bit_cast<std::uint32_t>(values[i]);  // one zero
  });
  return id;
}

/// Normals of length 1; 0 where there is none to speak of. Whatever space they are stored in: they are compared between
/// frames, so it should not turn with the camera.
Plane<glm::vec3> read_normal(const NormalChannels& channels, const FileSet& files, const Window& window,
                             Workers& workers) {
  const Plane<float> x = read_plane(pixels_of(files, channels[0]), window, 0, workers);
  const Plane<float> y = read_plane(pixels_of(files, channels[1]), window, 0, workers);
  const Plane<float> z = read_plane(pixels_of(files, channels[2]), window, 0, workers);
  Plane<glm::vec3> normal(window);
  workers.for_rows(window.y0, window.y1, [&](int row) {
    for (int i = 0; i < window.width(); ++i) {
      const glm::dvec3 n(double(x.row(row)[i]), double(y.row(row)[i]), double(z.row(row)[i]));
      const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
      normal.row(row)[i] = length > 0 && length < 1e30 ? glm::vec3(n / length) : glm::vec3(0.0f);
    }
  });
  return normal;
}

/// A mask with `neutral` where it says nothing: not finite, or outside its own window.
Plane<float> read_mask(const RawPlane& raw, const Window& window, float neutral, float most, Workers& workers) {
  Plane<float> mask = read_plane(raw, window, neutral, workers);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    float* row = mask.row(y);
    for (int i = 0; i < window.width(); ++i) row[i] = std::isfinite(row[i]) ? std::clamp(row[i], 0.0f, most) : neutral;
  });
  return mask;
}

/// The channels of a companion, interleaved; 0 where there is none, and outside their own window: no light comes from
/// there.
Plane<glm::vec4> read_companion(const Companion& companion, const FileSet& files, const Window& window,
                                Workers& workers) {
  Plane<glm::vec4> plane(window, kPresentBorder, glm::vec4(0.0f));
  for (std::size_t k = 0; k < 4; ++k) {
    if (!companion.channels[k]) continue;
    const Plane<float> channel = read_plane(pixels_of(files, *companion.channels[k]), window, 0.0f, workers);
    workers.for_rows(window.y0, window.y1, [&](int y) {
      for (int x = 0; x < window.width(); ++x) plane.row(y)[x][int(k)] = channel.row(y)[x];
    });
  }
  return plane;
}

/// What is let through, R G B, as stored; all of it where the channels have no data.
Plane<glm::vec3> read_transmittance(const TransmittanceChannels& from, const FileSet& files, const Window& window,
                                    Workers& workers) {
  Plane<glm::vec3> plane(window);
  for (std::size_t k = 0; k < 3; ++k) {
    const Plane<float> channel =
        read_plane(pixels_of(files, from.channels[k]), window, from.opacity ? 0.0f : 1.0f, workers);
    workers.for_rows(window.y0, window.y1, [&](int y) {
      for (int x = 0; x < window.width(); ++x)
        plane.row(y)[x][int(k)] = from.opacity ? 1 - channel.row(y)[x] : channel.row(y)[x];
    });
  }
  return plane;
}

/// Every channel of a part that is passed on.
template <class Add>
void add_whole_part(const FrameHeaders& headers, int part, const Add& add) {
  const std::vector<ChannelRef>& dropped = headers.passed_on.dropped;
  const std::size_t channels = headers.files.front().parts[std::size_t(part)].channels.size();
  for (int channel = 0; channel < int(channels); ++channel)
    if (std::find(dropped.begin(), dropped.end(), ChannelRef{0, part, channel}) == dropped.end())
      add({0, part, channel});
}

/// Parts of file 0 that cannot be copied as they are, because samples in it are used up.
std::vector<int> parts_to_rewrite(const FrameHeaders& headers) {
  std::vector<int> parts;
  if (headers.grid > 1)
    for (int p = 0; p < int(headers.files.front().parts.size()); ++p) parts.push_back(p);
  for (const ChannelRef& ref : headers.passed_on.dropped) parts.push_back(ref.part);
  for (const auto& [ref, name] : headers.passed_on.renamed) parts.push_back(ref.part);
  return parts;
}

std::vector<ChannelRef> channels_to_read(const FrameHeaders& headers, const ChannelNeeds& needs, int file) {
  std::vector<ChannelRef> wanted;
  const auto add = [&](ChannelRef ref) {
    if (ref.file == file && std::find(wanted.begin(), wanted.end(), ref) == wanted.end()) wanted.push_back(ref);
  };
  for (const Subject& subject : headers.subjects) {
    for (const auto& color : subject.color)
      if (color) add(*color);
    for (const Companion& companion : subject.companions)
      for (const auto& channel : companion.channels)
        if (channel) add(*channel);
    if (needs.depth && subject.depth) add(*subject.depth);
    if (needs.id && subject.id) add(*subject.id);
    if (needs.normal && subject.normal)
      for (const ChannelRef& axis : *subject.normal) add(axis);
    if (needs.reactive && subject.reactive) add(*subject.reactive);
    if (needs.responsive && subject.responsive) add(*subject.responsive);
    if (subject.transmittance)
      for (const ChannelRef& channel : subject.transmittance->channels) add(channel);
    const auto& vectors = subject.backward ? subject.backward : subject.forward;
    if (needs.motion && vectors) add((*vectors)[0]), add((*vectors)[1]);
    if (needs.forward && subject.forward) add((*subject.forward)[0]), add((*subject.forward)[1]);
    if (!needs.whole_parts || file != 0) continue;
    for (const int part : parts_of(subject)) add_whole_part(headers, part, add);
  }
  // Parts that lose channels are written anew as well, though nothing in them is resolved.
  if (needs.whole_parts && file == 0)
    for (const int part : parts_to_rewrite(headers)) add_whole_part(headers, part, add);
  return wanted;
}

}  // namespace

FileSet read_files(const FrameHeaders& headers, const ChannelNeeds& needs, Workers& workers) {
  FileSet pixels;
  for (int file = 0; file < int(headers.files.size()); ++file)
    pixels.push_back(read_shown_channels(headers, file, channels_to_read(headers, needs, file), workers));
  return pixels;
}

Plane<glm::vec2> read_vectors(const VectorChannels& channels, const MotionEncoding& encoding, const FileSet& files,
                              const Window& window, const Window& display_window, double max_length,
                              std::size_t& unusable, Workers& workers) {
  const float outside = std::numeric_limits<float>::quiet_NaN();
  const Plane<float> x = read_plane(pixels_of(files, channels[0]), window, outside, workers);
  const Plane<float> y = read_plane(pixels_of(files, channels[1]), window, outside, workers);
  return decode_motion(x, y, encoding, display_window, max_length, workers, unusable);
}

Present read_present(const Subject& subject, const FileSet& pixels, const Window& window, const Window& display_window,
                     const ReadOptions& options, const ColorConversion* into_working_space, std::size_t& vectors_bad,
                     Workers& workers) {
  Present present;
  present.color = read_color(subject, pixels, window, workers);
  if (into_working_space) into_working_space->apply(present.color, workers);
  sanitize(present, workers);
  for (const Companion& companion : subject.companions) {
    present.companions.push_back(read_companion(companion, pixels, window, workers));
    present.companion_is_color.push_back(companion.color);
    if (companion.color && into_working_space) into_working_space->apply(present.companions.back(), workers);
  }
  sanitize_companions(present, workers);

  if (options.use_depth && subject.depth) {
    present.depth =
        read_plane(pixels_of(pixels, *subject.depth), window, std::numeric_limits<float>::infinity(), workers);
    canonical_depth(present.depth, options.motion.depth_kind, subject.background_depth, workers);
  }
  if (options.use_id && subject.id) present.id = read_id(pixels_of(pixels, *subject.id), window, workers);
  if (options.use_normal && subject.normal) present.normal = read_normal(*subject.normal, pixels, window, workers);
  if (options.use_reactive && subject.reactive)
    present.reactive = read_mask(pixels_of(pixels, *subject.reactive), window, 0, 1, workers);
  if (options.use_responsive && subject.responsive)
    present.responsive = read_mask(pixels_of(pixels, *subject.responsive), window, 1, 1e6f, workers);
  if (subject.transmittance)
    present.transmittance = read_transmittance(*subject.transmittance, pixels, window, workers);
  if (!options.use_motion) return present;

  const auto read = [&](const VectorChannels& channels, const MotionEncoding& encoding) {
    return read_vectors(channels, encoding, pixels, window, display_window, options.motion.max_length, vectors_bad,
                        workers);
  };
  if (subject.backward) present.motion = read(*subject.backward, subject.backward_encoding);
  if (subject.forward && (options.use_forward || !subject.backward))
    present.forward = read(*subject.forward, subject.forward_encoding);
  return present;
}

}  // namespace varve
