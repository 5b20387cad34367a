#include "exr/write_frame.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "exr/channel_names.h"
#include "exr/chunk_bytes.h"
#include "exr/container.h"
#include "exr/header_bytes.h"
#include "exr/library_encode.h"
#include "exr/output_bytes.h"
#include "exr/write_chunks.h"

namespace varve {
namespace {

// One part on its way out: its header as bytes, and its pixels where it is not copied.
struct PlannedPart {
  Part part;
  RawPart raw;
  std::vector<const RawPlane*> planes;  // in the order of part.channels; empty: chunks are copied
};

bool has_floats(const Part& part) {
  return std::any_of(part.channels.begin(), part.channels.end(),
                     [](const Channel& c) { return c.type == PixelType::float32; });
}

// Data that means something else as soon as one bit changes.
bool is_identity(const Channel& channel) {
  const ChannelClass kind = classify(channel);
  return channel.type == PixelType::uint32 || kind == ChannelClass::id || kind == ChannelClass::cryptomatte;
}

Compression choose_compression(const OutputPart& request, const Part& part, const std::string& path) {
  if (!request.compression) {
    // PXR24 shortens floats and keeps everything else.
    const bool lossy = is_lossy(part.compression) && (part.compression != Compression::pxr24 || has_floats(part));
    return lossy ? Compression::zip : part.compression;
  }
  for (const Channel& channel : part.channels)
    if (is_lossy(*request.compression) && is_identity(channel))
      throw Failure(ExitCode::usage, std::string("compression ") + name_of(*request.compression) +
                                         " would damage the ids in channel '" + channel.name + "' of '" + path +
                                         "'; choose zip, or leave the compression as it is");
  return *request.compression;
}

// Channels by name, each with its plane, which must hold the part's whole data window.
void take_channels(const OutputPart& request, const std::string& path, PlannedPart& plan) {
  std::vector<OutputChannel> channels = request.channels;
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

PlannedPart plan_part(const Container& source, const OutputPart& request, const std::string& path, bool multi_part) {
  PlannedPart plan;
  plan.part = source.header.parts.at(std::size_t(request.source_part));
  plan.raw = source.raw[std::size_t(request.source_part)];
  if (!request.copy_chunks) {
    if (is_deep(plan.part))
      throw Failure(ExitCode::output, "cannot write flat channels to '" + path +
                                          "': " + part_in_words(source.header, request.source_part) +
                                          " is deep; copy it as it is");
    take_channels(request, path, plan);
    plan.part.compression = choose_compression(request, plan.part, path);
    plan.part.storage = Storage::scanline;
    plan.raw.remove("tiles");
    plan.raw.set("channels", "chlist", encode_channels(plan.part.channels));
    plan.raw.set("compression", "compression", std::string(1, char(plan.part.compression)));
    plan.raw.set("lineOrder", "lineOrder", std::string(1, '\0'));  // increasing y
    plan.raw.chunks = chunk_count(plan.part, {});
    if (plan.raw.find("type")) plan.raw.set("type", "string", "scanlineimage");
  }
  if (multi_part && !plan.raw.find("type"))
    plan.raw.set("type", "string", plan.part.storage == Storage::tiled ? "tiledimage" : "scanlineimage");
  if (multi_part || plan.raw.find("chunkCount")) {
    std::string count;
    append(count, std::int32_t(plan.raw.chunks));
    plan.raw.set("chunkCount", "int", count);
  }
  return plan;
}

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

std::vector<std::uint64_t> write_chunks(const Container& source, const OutputPart& request, const PlannedPart& plan,
                                        const WriteOptions& options, const ChunkTarget& target, Workers& workers) {
  if (request.copy_chunks) return copy_chunks(source, request.source_part, target);
  const Compression c = plan.part.compression;
  if (c == Compression::none || c == Compression::zip || c == Compression::zips)
    return encode_chunks(plan.part, plan.planes, options.zip_level, target, workers);
  return copy_chunks(encode_by_library(plan.part, plan.planes, workers.count()), 0, target);
}

void check_names(const std::vector<PlannedPart>& parts, const std::string& path) {
  std::set<std::string> names;
  for (const PlannedPart& plan : parts)
    if (parts.size() > 1 && (plan.part.name.empty() || !names.insert(plan.part.name).second))
      throw Failure(ExitCode::output, "cannot write '" + path + "': its parts need names of their own, and '" +
                                          plan.part.name + "' is empty or used twice");
}

}  // namespace

void write_frame(const std::string& path, const FileHeader& source, std::span<const OutputPart> parts,
                 const WriteOptions& options, Workers& workers) {
  if (parts.empty()) throw Failure(ExitCode::output, "cannot write '" + path + "': there is no part to write");
  if (!(options.zip_level >= 1 && options.zip_level <= 9))
    throw Failure(ExitCode::usage, "the ZIP level " + std::to_string(options.zip_level) + " is not between 1 and 9");
  check_writable(path);
  const Container original = reopen(source);
  std::vector<PlannedPart> plans;
  for (const OutputPart& request : parts) plans.push_back(plan_part(original, request, path, parts.size() > 1));
  check_names(plans, path);
  for (const auto& [name, text] : options.attributes) plans[0].raw.set(name, "string", text);

  OutputBytes file(path);
  const std::string header = header_bytes(plans);
  file.append(header.data(), header.size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const ChunkTarget target{&file, parts.size() > 1 ? int(i) : -1};
    const std::vector<std::uint64_t> offsets = write_chunks(original, parts[i], plans[i], options, target, workers);
    file.overwrite(plans[i].raw.table_offset, offsets.data(), offsets.size() * sizeof offsets[0]);
  }
  file.commit();
}

}  // namespace varve
