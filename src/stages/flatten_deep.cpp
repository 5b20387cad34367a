#include "stages/flatten_deep.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "exr/channel_names.h"
#include "exr/convert.h"
#include "exr/deep_channels.h"
#include "plan/find_samples.h"

namespace varve {
namespace {

/// A channel on its way from samples to pixels.
struct Lane {
  int channel = 0;
  DeepUse use;
  RawPlane* plane = nullptr;
};

/// One worker's room.
struct Scratch {
  FlattenScratch flatten;
  std::vector<DeepSample> pixel;
  std::vector<float> z, z_back;
  std::array<std::vector<float>, 4> opacity;
  std::vector<std::vector<float>> light;  ///< samples of the line, for each lane that is light
  std::vector<std::vector<float>> row;    ///< pixels of the line, for each lane that is light or opacity
  DeepCounts counts;
};

void store_floats(PixelType type, const float* from, std::byte* to, std::size_t count) {
  if (type == PixelType::float16)
    to_half_clamped(from, reinterpret_cast<std::uint16_t*>(to), count);
  else
    std::memcpy(to, from, count * sizeof *from);
}

/// Flattens the lines of one part.
class Flattener {
 public:
  /// `shown` may be null.
  Flattener(const Part& part, std::vector<Lane> lanes, LayerRule rule, CombinePlanes* shown)
      : part_(part), channels_(deep_channels(part)), lanes_(std::move(lanes)), rule_(rule), shown_(shown) {
    // The color that the winner is chosen by, and that tells coinciding samples apart.
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      if (const DeepUse use = lanes_[i].use; use.role == DeepRole::light && use.lane < 3 && !color_[use.lane])
        color_[use.lane] = i;
  }

  void take(const DeepLine& line, Scratch& s) const {
    unpack(line, s);
    for (std::size_t x = 0; x < line.pixels(); ++x) flatten_pixel(line, x, s);
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      if (lanes_[i].use.role != DeepRole::winner)
        store_floats(lanes_[i].plane->type, s.row[i].data(), place(lanes_[i], line, 0), line.pixels());
  }

 private:
  void to_floats(const DeepLine& line, const std::optional<int>& channel, std::vector<float>& to) const {
    if (!channel) return;
    const std::size_t c = std::size_t(*channel);
    to.resize(line.count());
    to_float(part_.channels[c].type, line.samples[c], to.data(), to.size());
  }

  void unpack(const DeepLine& line, Scratch& s) const {
    to_floats(line, channels_.z, s.z);
    to_floats(line, channels_.z_back, s.z_back);
    for (std::size_t k = 0; k < 4; ++k) to_floats(line, channels_.opacity[k], s.opacity[k]);
    s.light.resize(lanes_.size());
    s.row.resize(lanes_.size());
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      if (lanes_[i].use.role == DeepRole::light) to_floats(line, lanes_[i].channel, s.light[i]);
      if (lanes_[i].use.role != DeepRole::winner) s.row[i].assign(line.pixels(), 0.0f);
    }
  }

  /// Sample `index` of a pixel whose samples begin at `first` of the line. Without a depth they lie as they are stored.
  DeepSample sample(const Scratch& s, std::size_t first, std::size_t index) const {
    const std::size_t at = first + index;
    DeepSample sample;
    sample.index = std::uint32_t(index);
    sample.front = channels_.z ? double(s.z[at]) : double(index);
    sample.back = channels_.z && channels_.z_back ? double(s.z_back[at]) : sample.front;
    const double alpha = channels_.opacity[3] ? double(s.opacity[3][at]) : 1;
    for (std::size_t k = 0; k < 4; ++k) {
      sample.opacity[int(k)] = channels_.opacity[k] ? double(s.opacity[k][at]) : alpha;
      if (k < 3 && color_[k]) sample.color[int(k)] = double(s.light[*color_[k]][at]);
    }
    if (channels_.colored && !channels_.opacity[3])
      sample.opacity[3] = 0.2126 * sample.opacity[0] + 0.7152 * sample.opacity[1] + 0.0722 * sample.opacity[2];
    return sample;
  }

  void flatten_pixel(const DeepLine& line, std::size_t x, Scratch& s) const {
    const std::size_t first = line.first[x], count = line.first[x + 1] - first;
    s.counts.pixels += 1;
    s.counts.samples += count;
    s.counts.most = std::max<std::uint64_t>(s.counts.most, count);
    s.pixel.clear();
    for (std::size_t i = 0; i < count; ++i)
      if (DeepSample one = sample(s, first, i); repair(one, s.counts.defects)) s.pixel.push_back(one);
    if (s.pixel.empty()) return leave_empty(line, x);
    const FlatPixel flat = flatten(s.pixel, channels_.colored, rule_, s.flatten);
    if (shown_) {
      shown_->winner.at(line.x0 + int(x), line.y) = float(flat.place + 1);
      shown_->variation.at(line.x0 + int(x), line.y) = float(flat.variation);
      shown_->touched.at(line.x0 + int(x), line.y) = float(flat.seen);
    }
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      const DeepUse use = lanes_[i].use;
      if (use.role == DeepRole::winner) {
        const std::size_t bytes = bytes_per_pixel(lanes_[i].plane->type);
        const std::byte* samples = line.samples[std::size_t(lanes_[i].channel)];
        std::memcpy(place(lanes_[i], line, x), samples + (first + flat.winner) * bytes, bytes);
      } else if (use.role == DeepRole::light ? use.lane < 3 && color_[use.lane] == i : use.lane == 3) {
        s.row[i][x] = float(flat.color[int(use.lane)]);
      } else {
        s.row[i][x] = float(sum_up(s, use, s.light[i], first));
      }
    }
  }

  /// A channel beside the color, by the visibilities of the pixel that was flattened last.
  static double sum_up(const Scratch& s, DeepUse use, const std::vector<float>& light, std::size_t first) {
    double sum = 0;
    for (std::size_t k = 0; k < s.pixel.size(); ++k) {
      const DeepSample& sample = s.pixel[k];
      const double visibility = s.flatten.visibility[use.lane][k];
      if (visibility > 0)
        sum += visibility *
               (use.role == DeepRole::light ? double(light[first + sample.index]) : sample.opacity[int(use.lane)]);
    }
    return sum;
  }

  void leave_empty(const DeepLine& line, std::size_t x) const {
    for (const Lane& lane : lanes_) {
      if (lane.use.role != DeepRole::winner) continue;
      std::byte* to = place(lane, line, x);
      std::memset(to, 0, bytes_per_pixel(lane.plane->type));
      const float background = deep_background(lane.plane->type);
      if (classify(part_.channels[std::size_t(lane.channel)]) == ChannelClass::depth)
        store_floats(lane.plane->type, &background, to, 1);
    }
  }

  static std::byte* place(const Lane& lane, const DeepLine& line, std::size_t x) {
    const Window& window = lane.plane->window;
    return lane.plane->row(line.y - window.y0) +
           (std::size_t(line.x0 - window.x0) + x) * bytes_per_pixel(lane.plane->type);
  }

  const Part& part_;
  DeepChannels channels_;
  std::vector<Lane> lanes_;
  std::array<std::optional<std::size_t>, 3> color_;  ///< lanes of R, G and B
  LayerRule rule_;
  CombinePlanes* shown_;
};

void flatten_part(const FileHeader& header, int part, std::span<const ChannelRef> channels,
                  std::span<const ChannelRef> precise, const FlattenOptions& options, std::vector<RawPlane>& planes,
                  DeepFrame& deep, Workers& workers) {
  const Part& described = header.parts[std::size_t(part)];
  std::vector<Lane> lanes;
  for (const ChannelRef& ref : channels) {
    if (ref.part != part) continue;
    RawPlane& plane = planes[std::size_t(ref.channel)];
    const DeepUse use = deep_use(described, ref.channel);
    if (use.role == DeepRole::none || !plane.empty()) continue;
    const bool as_float =
        use.role != DeepRole::winner && std::find(precise.begin(), precise.end(), ref) != precise.end();
    plane = make_raw_plane(as_float ? PixelType::float32 : described.channels[std::size_t(ref.channel)].type,
                           described.data_window);
    lanes.push_back({ref.channel, use, &plane});
  }
  if (lanes.empty()) return;
  CombinePlanes* shown = options.show ? &deep.combined[part] : nullptr;
  if (shown)
    for (Plane<float>* plane : {&shown->winner, &shown->variation, &shown->touched})
      *plane = Plane<float>(described.data_window, 0, 0.0f);
  const Flattener flattener(described, std::move(lanes), options.rule, shown);
  std::vector<Scratch> scratch(std::size_t(workers.count()));
  read_deep(header, part, options.limits, workers,
            [&](const DeepLine& line, int worker) { flattener.take(line, scratch[std::size_t(worker)]); });
  for (const Scratch& s : scratch) deep.counts += s.counts;
}

}  // namespace

DeepCounts& DeepCounts::operator+=(const DeepCounts& other) {
  pixels += other.pixels;
  samples += other.samples;
  most = std::max(most, other.most);
  defects += other.defects;
  return *this;
}

FramePixels read_flat(const FrameHeaders& headers, int file, std::span<const ChannelRef> channels,
                      std::span<const ChannelRef> precise, const FlattenOptions& options, DeepFrame& deep,
                      Workers& workers) {
  const FileHeader& header = headers.files[std::size_t(file)];
  std::vector<ChannelRef> flat;
  std::vector<char> is_flattened(header.parts.size(), 0);
  for (const ChannelRef& ref : channels) {
    // A grid of samples is not looked for in deep parts: reading it refuses them.
    is_flattened[std::size_t(ref.part)] = is_deep(header.parts.at(std::size_t(ref.part))) && headers.stored.empty();
    if (!is_flattened[std::size_t(ref.part)]) flat.push_back(ref);
  }
  FramePixels pixels = read_shown_channels(headers, file, flat, workers);
  for (std::size_t p = 0; p < is_flattened.size(); ++p)
    if (is_flattened[p]) flatten_part(header, int(p), channels, precise, options, pixels.planes[p], deep, workers);
  return pixels;
}

}  // namespace varve
