#include "exr/planned_file.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "exr/header_bytes.h"
#include "exr/library_encode.h"
#include "exr/output_bytes.h"

namespace varve {
namespace {

std::uint32_t version_of(const std::vector<PlannedPart>& parts) {
  std::uint32_t version = 2;
  if (parts.size() > 1) version |= kMultiPartFlag;
  if (parts.size() == 1 && parts[0].part.storage == Storage::tiled) version |= kTiledFlag;
  for (const PlannedPart& plan : parts) {
    if (is_deep(plan.part)) version |= kDeepFlag;
    for (const RawAttribute& a : plan.raw.attributes)
      if (a.name.size() > 31 || a.type.size() > 31) version |= kLongNamesFlag;
    for (const Channel& c : plan.part.channels)
      if (c.name.size() > 31) version |= kLongNamesFlag;
  }
  return version;
}

// Headers, and chunk tables still blank; sets where each table lies.
std::string header_bytes(std::vector<PlannedPart>& parts) {
  std::string bytes;
  append(bytes, std::uint32_t(20000630));
  append(bytes, version_of(parts));
  for (const PlannedPart& plan : parts) {
    for (const RawAttribute& a : plan.raw.attributes) {
      bytes.append(a.name).append(1, '\0').append(a.type).append(1, '\0');
      append(bytes, std::uint32_t(a.value.size()));
      bytes += a.value;
    }
    bytes += '\0';
  }
  if (parts.size() > 1) bytes += '\0';
  for (PlannedPart& plan : parts) {
    plan.raw.table_offset = bytes.size();
    bytes.append(8 * std::size_t(plan.raw.chunks), '\0');
  }
  return bytes;
}

void check_names(const std::vector<PlannedPart>& parts, const std::string& path) {
  std::set<std::string> names;
  for (const PlannedPart& plan : parts)
    if (parts.size() > 1 && (plan.part.name.empty() || !names.insert(plan.part.name).second))
      throw Failure(ExitCode::output, "cannot write '" + path + "': its parts need names of their own, and '" +
                                          plan.part.name + "' is empty or used twice");
}

}  // namespace

void take_channels(std::vector<OutputChannel> channels, const std::string& path, PlannedPart& plan) {
  std::sort(channels.begin(), channels.end(),
            [](const OutputChannel& a, const OutputChannel& b) { return a.channel.name < b.channel.name; });
  plan.part.channels.clear();
  for (const OutputChannel& c : channels) {
    const std::string in_words = "channel '" + c.channel.name + "' of '" + path + "'";
    if (c.channel.name.empty() || c.channel.name.size() > 255)
      throw Failure(ExitCode::output, "cannot write " + in_words + ": a channel name has 1 to 255 characters");
    if (!plan.part.channels.empty() && plan.part.channels.back().name == c.channel.name)
      throw Failure(ExitCode::output, "cannot write " + in_words + ": there are two channels of that name");
    const Window& need = plan.part.data_window;
    const bool fits = c.pixels && c.pixels->type == c.channel.type && c.pixels->x_sampling == c.channel.x_sampling &&
                      c.pixels->y_sampling == c.channel.y_sampling && intersect(c.pixels->window, need) == need;
    if (!fits)
      throw Failure(ExitCode::output, "cannot write " + in_words + ": its pixels do not cover the data window");
    plan.part.channels.push_back(c.channel);
    plan.planes.push_back(c.pixels);
  }
  if (channels.empty()) throw Failure(ExitCode::output, "cannot write '" + path + "': a part has no channels");
}

void set_scanlines(PlannedPart& plan) {
  if (is_deep(plan.part))
    for (const char* name : {"version", "maxSamplesPerPixel"}) plan.raw.remove(name);
  plan.part.storage = Storage::scanline;
  plan.raw.remove("tiles");
  plan.raw.set("channels", "chlist", encode_channels(plan.part.channels));
  plan.raw.set("compression", "compression", std::string(1, char(plan.part.compression)));
  plan.raw.set("lineOrder", "lineOrder", std::string(1, '\0'));  // increasing y
  plan.raw.chunks = chunk_count(plan.part, {});
  if (plan.raw.find("type")) plan.raw.set("type", "string", "scanlineimage");
}

void set_part_type(PlannedPart& plan, bool multi_part) {
  if (multi_part && !plan.raw.find("type"))
    plan.raw.set("type", "string", plan.part.storage == Storage::tiled ? "tiledimage" : "scanlineimage");
  if (multi_part || plan.raw.find("chunkCount")) {
    std::string count;
    append(count, std::int32_t(plan.raw.chunks));
    plan.raw.set("chunkCount", "int", count);
  }
}

std::vector<std::uint64_t> encode_part(const PlannedPart& plan, int zip_level, const ChunkTarget& target,
                                       Workers& workers) {
  const Compression c = plan.part.compression;
  if (c == Compression::none || c == Compression::zip || c == Compression::zips)
    return encode_chunks(plan.part, plan.planes, zip_level, target, workers);
  return copy_chunks(encode_by_library(plan.part, plan.planes, workers.count()), 0, target);
}

void write_planned(const std::string& path, std::vector<PlannedPart>& parts,
                   const std::function<std::vector<std::uint64_t>(std::size_t, const ChunkTarget&)>& write_part,
                   const std::function<void()>& check) {
  check_names(parts, path);
  OutputBytes file(path);
  const std::string header = header_bytes(parts);
  file.append(header.data(), header.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ChunkTarget target{&file, parts.size() > 1 ? int(i) : -1};
    const std::vector<std::uint64_t> offsets = write_part(i, target);
    file.overwrite(parts[i].raw.table_offset, offsets.data(), offsets.size() * sizeof offsets[0]);
  }
  if (check) check();
  file.commit();
}

}  // namespace varve
