#include "exr/write_frame.h"

#include <algorithm>

#include "base/error.h"
#include "exr/channel_names.h"
#include "exr/chunk_bytes.h"
#include "exr/header_bytes.h"
#include "exr/planned_file.h"

namespace varve {
namespace {

bool has_floats(const Part& part) {
  return std::any_of(part.channels.begin(), part.channels.end(),
                     [](const Channel& c) { return c.type == PixelType::float32; });
}

// Both ends inclusive, as OpenEXR has it.
std::string box_bytes(const Window& w) {
  std::string bytes;
  for (const int edge : {w.x0, w.y0, w.x1 - 1, w.y1 - 1}) append(bytes, std::int32_t(edge));
  return bytes;
}

/// What a part says of itself, where that is not what its source says.
void change_header(const OutputPart& request, PlannedPart& plan) {
  if (request.windows) {
    plan.part.data_window = request.windows->first;
    plan.part.display_window = request.windows->second;
    plan.raw.set("dataWindow", "box2i", box_bytes(plan.part.data_window));
    plan.raw.set("displayWindow", "box2i", box_bytes(plan.part.display_window));
  }
  if (request.name) {
    plan.part.name = *request.name;
    if (request.name->empty())
      plan.raw.remove("name");
    else
      plan.raw.set("name", "string", *request.name);
  }
  for (const std::string& attribute : request.without) plan.raw.remove(attribute);
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

PlannedPart plan_part(const Container& source, const OutputPart& request, const std::string& path, bool multi_part) {
  PlannedPart plan;
  plan.part = source.header.parts.at(std::size_t(request.source_part));
  plan.raw = source.raw[std::size_t(request.source_part)];
  change_header(request, plan);
  if (!request.copy_chunks) {
    take_channels(request.channels, path, plan);
    plan.part.compression = choose_compression(request, plan.part, path);
    set_scanlines(plan);
  }
  set_part_type(plan, multi_part);
  return plan;
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
  for (const auto& [name, text] : options.attributes) plans[0].raw.set(name, "string", text);
  const auto write_part = [&](std::size_t i, const ChunkTarget& target) {
    return parts[i].copy_chunks ? copy_chunks(original, parts[i].source_part, target)
                                : encode_part(plans[i], options.zip_level, target, workers);
  };
  write_planned(path, plans, write_part, options.check);
}

}  // namespace varve
