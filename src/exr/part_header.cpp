// One part's attributes as what they mean, with every claim checked.
#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "exr/header_bytes.h"

namespace varve {
namespace {

[[noreturn]] void refuse(const std::string& reason) { throw std::runtime_error(reason); }

const std::string& required(const RawPart& raw, const char* name, const char* type, std::size_t size) {
  const RawAttribute* attribute = raw.find(name);
  if (!attribute) refuse(std::string("its header lacks the attribute '") + name + "'");
  if (attribute->type != type || (size > 0 && attribute->value.size() != size))
    refuse(std::string("its attribute '") + name + "' is damaged");
  return attribute->value;
}

std::string text_of(const RawPart& raw, const char* name) {
  const RawAttribute* attribute = raw.find(name);
  return attribute && attribute->type == "string" ? attribute->value : std::string();
}

Window window_of(const RawPart& raw, const char* name, const ReadLimits& limits) {
  const std::string& value = required(raw, name, "box2i", 16);
  std::int64_t box[4];
  for (int i = 0; i < 4; ++i) box[i] = load<std::int32_t>(value.data() + 4 * i);
  for (std::int64_t c : box)
    if (std::abs(c) >= limits.edge)
      refuse(std::string("its ") + name + " reaches to " + std::to_string(c) + ", beyond the limit of " +
             std::to_string(limits.edge) + " pixels");
  const std::int64_t width = box[2] - box[0] + 1, height = box[3] - box[1] + 1;
  if (width < 1 || height < 1) refuse(std::string("its ") + name + " is empty");
  if (std::max(width, height) > limits.edge)
    refuse(std::string("its ") + name + " measures " + std::to_string(width) + "x" + std::to_string(height) +
           ", beyond the limit of " + std::to_string(limits.edge) + " pixels a side");
  return {int(box[0]), int(box[1]), int(box[2] + 1), int(box[3] + 1)};
}

PixelType pixel_type(std::int32_t stored) {
  switch (stored) {
    case 0:
      return PixelType::uint32;
    case 1:
      return PixelType::float16;
    case 2:
      return PixelType::float32;
    default:
      refuse("it has a channel of an unknown pixel type");
  }
}

std::vector<Channel> channels_of(const RawPart& raw, const Window& window, const ReadLimits& limits) {
  const std::string& list = required(raw, "channels", "chlist", 0);
  std::vector<Channel> channels;
  std::size_t at = 0;
  while (at < list.size() && list[at] != '\0') {
    const std::size_t end = list.find('\0', at);
    if (end == std::string::npos || list.size() - end < 17 || end - at > 255) refuse("its channel list is damaged");
    if (channels.size() >= std::size_t(limits.channels))
      refuse("it has more than " + std::to_string(limits.channels) + " channels in one part");
    const char* entry = list.data() + end + 1;
    Channel channel{list.substr(at, end - at), pixel_type(load<std::int32_t>(entry)), load<std::int32_t>(entry + 8),
                    load<std::int32_t>(entry + 12), entry[4] != 0};
    const int xs = channel.x_sampling, ys = channel.y_sampling;
    if (xs < 1 || ys < 1 || window.x0 % xs != 0 || window.y0 % ys != 0 || window.width() % xs != 0 ||
        window.height() % ys != 0)
      refuse("the sampling of its channel '" + channel.name + "' does not fit its data window");
    channels.push_back(std::move(channel));
    at = end + 17;
  }
  if (at + 1 != list.size() || channels.empty()) refuse("its channel list is damaged or empty");
  // Chunks hold channels in the order of names, whatever the order of the list.
  std::sort(channels.begin(), channels.end(), [](const Channel& a, const Channel& b) { return a.name < b.name; });
  for (std::size_t i = 1; i < channels.size(); ++i)
    if (channels[i].name == channels[i - 1].name) refuse("it has two channels named '" + channels[i].name + "'");
  return channels;
}

Storage storage_of(const RawPart& raw, std::uint32_t flags) {
  // Files of one flat part say by a flag whether they are tiled; `type` is optional there and not looked at.
  if (!(flags & (kMultiPartFlag | kDeepFlag))) return flags & kTiledFlag ? Storage::tiled : Storage::scanline;
  const std::string type = text_of(raw, "type");
  if (type == "scanlineimage") return Storage::scanline;
  if (type == "tiledimage") return Storage::tiled;
  if (type == "deepscanline") return Storage::deep_scanline;
  if (type == "deeptile") return Storage::deep_tiled;
  refuse(type.empty() ? "a part does not say its type" : "it has a part of the unknown type '" + type + "'");
}

Tiling tiling_of(const RawPart& raw, const ReadLimits& limits) {
  const std::string& value = required(raw, "tiles", "tiledesc", 9);
  Tiling tiling;
  tiling.width = load<std::uint32_t>(value.data());
  tiling.height = load<std::uint32_t>(value.data() + 4);
  const unsigned mode = static_cast<unsigned char>(value[8]);
  if ((mode & 15) > 2 || (mode >> 4) > 1) refuse("its tile description is damaged");
  tiling.levels = Tiling::Levels(mode & 15);
  tiling.round_up = (mode >> 4) == 1;
  const std::uint64_t edge = std::uint64_t(limits.edge);
  if (tiling.width < 1 || tiling.height < 1 || tiling.width > edge || tiling.height > edge ||
      std::uint64_t(tiling.width) * tiling.height > limits.tile_pixels)
    refuse("its tiles measure " + std::to_string(tiling.width) + "x" + std::to_string(tiling.height) +
           ", beyond the limit of " + std::to_string(limits.tile_pixels) + " pixels");
  return tiling;
}

bool tiled(Storage storage) { return storage == Storage::tiled || storage == Storage::deep_tiled; }

}  // namespace

Part decode_part(RawPart& raw, std::uint32_t flags, const ReadLimits& limits) {
  Part part;
  part.name = text_of(raw, "name");
  part.view = text_of(raw, "view");
  part.storage = storage_of(raw, flags);
  const int compression = static_cast<unsigned char>(required(raw, "compression", "compression", 1)[0]);
  if (compression > int(Compression::dwab)) refuse("its compression is unknown to this program");
  part.compression = Compression(compression);
  part.data_window = window_of(raw, "dataWindow", limits);
  part.display_window = window_of(raw, "displayWindow", limits);
  if (part.data_window.pixels() > limits.pixels_per_part)
    refuse("its data window holds " + std::to_string(part.data_window.pixels()) + " pixels, beyond the limit of " +
           std::to_string(limits.pixels_per_part));
  part.channels = channels_of(raw, part.data_window, limits);
  if (tiled(part.storage)) {
    raw.tiling = tiling_of(raw, limits);
    for (const Channel& channel : part.channels)
      if (channel.x_sampling != 1 || channel.y_sampling != 1) refuse("it has tiles with subsampled channels");
  }
  raw.chunks = chunk_count(part, raw.tiling);
  for (const RawAttribute& attribute : raw.attributes) part.attributes.push_back(decode_attribute(attribute));
  return part;
}

std::string encode_channels(std::vector<Channel> channels) {
  std::sort(channels.begin(), channels.end(), [](const Channel& a, const Channel& b) { return a.name < b.name; });
  std::string list;
  for (const Channel& channel : channels) {
    list += channel.name;
    list += '\0';
    append(list, std::int32_t(channel.type));
    append(list, std::uint32_t(channel.perceptually_linear ? 1 : 0));  // one flag byte, three reserved
    append(list, std::int32_t(channel.x_sampling));
    append(list, std::int32_t(channel.y_sampling));
  }
  list += '\0';
  return list;
}

int lines_per_chunk(Compression compression) {
  switch (compression) {
    case Compression::none:
    case Compression::rle:
    case Compression::zips:
      return 1;
    case Compression::zip:
    case Compression::pxr24:
      return 16;
    case Compression::piz:
    case Compression::b44:
    case Compression::b44a:
    case Compression::dwaa:
      return 32;
    default:
      return 256;
  }
}

std::uint64_t chunk_count(const Part& part, const Tiling& tiling) {
  const std::uint64_t width = part.data_window.pixels() / std::uint64_t(std::max(1, part.data_window.height()));
  const std::uint64_t height = std::uint64_t(part.data_window.height());
  const auto over = [](std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; };
  if (!tiled(part.storage)) return over(height, std::uint64_t(lines_per_chunk(part.compression)));
  const auto size = [&](std::uint64_t full, int level) {
    const std::uint64_t down = full >> level;
    return std::max<std::uint64_t>(1, tiling.round_up && (down << level) < full ? down + 1 : down);
  };
  const auto levels = [&](std::uint64_t full) {
    int n = 0;
    while ((full >> (n + 1)) > 0) ++n;
    return n + 1 + (tiling.round_up && (full & (full - 1)) != 0 ? 1 : 0);
  };
  const auto tiles = [&](int x, int y) {
    return over(size(width, x), tiling.width) * over(size(height, y), tiling.height);
  };
  std::uint64_t count = 0;
  switch (tiling.levels) {
    case Tiling::Levels::one:
      count = tiles(0, 0);
      break;
    case Tiling::Levels::mipmap:
      for (int i = 0; i < levels(std::max(width, height)); ++i) count += tiles(i, i);
      break;
    case Tiling::Levels::ripmap:
      for (int y = 0; y < levels(height); ++y)
        for (int x = 0; x < levels(width); ++x) count += tiles(x, y);
      break;
  }
  return count;
}

int samples_in(int low, int high, int sampling) {
  // Both ends are divided downwards, so that negative origins count like positive ones.
  const auto floor_div = [](int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); };
  return floor_div(high - 1, sampling) - floor_div(low - 1, sampling);
}

std::size_t row_bytes(const Channel& channel, const Window& window, int y) {
  if (y % channel.y_sampling != 0) return 0;
  return std::size_t(samples_in(window.x0, window.x1, channel.x_sampling)) * bytes_per_pixel(channel.type);
}

}  // namespace varve
