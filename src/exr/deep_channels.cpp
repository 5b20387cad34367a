#include "exr/deep_channels.h"

#include <string_view>

#include "exr/channel_index.h"

namespace varve {
namespace {

std::string base_of(const Channel& channel) { return lower_case(split_at_dots(channel.name).back()); }

std::optional<int> find_base(const Part& part, std::string_view base) {
  std::optional<int> found;
  for (int c = 0; c < int(part.channels.size()); ++c) {
    const std::string& name = part.channels[std::size_t(c)].name;
    if (base_of(part.channels[std::size_t(c)]) != base || part.channels[std::size_t(c)].type == PixelType::uint32)
      continue;
    if (name.find('.') == std::string::npos) return c;
    if (!found) found = c;
  }
  return found;
}

}  // namespace

DeepChannels deep_channels(const Part& part) {
  DeepChannels channels;
  channels.z = find_base(part, "z");
  channels.z_back = find_base(part, "zback");
  constexpr std::array<std::string_view, 3> kColored = {"ar", "ag", "ab"};
  for (std::size_t k = 0; k < 3; ++k) {
    channels.opacity[k] = find_base(part, kColored[k]);
    channels.colored = channels.colored || channels.opacity[k];
  }
  channels.opacity[3] = find_base(part, "a");
  if (!channels.opacity[3]) channels.opacity[3] = find_base(part, "alpha");
  return channels;
}

float deep_background(PixelType type) { return type == PixelType::float16 ? 65504.0f : 1e10f; }

DeepUse deep_use(const Part& part, int channel) {
  const Channel& what = part.channels[std::size_t(channel)];
  const std::string base = base_of(what);
  if (base == "zback") return {DeepRole::none};
  const auto lane = [&](char letter) { return letter == 'r' ? 0u : letter == 'g' ? 1u : letter == 'b' ? 2u : 3u; };
  switch (classify(what)) {
    case ChannelClass::color:
      return {DeepRole::light, base == "ry" || base == "by" ? 3u : lane(base[0])};
    case ChannelClass::alpha:
      return {DeepRole::opacity, base.size() == 2 && base[0] == 'a' ? lane(base[1]) : 3u};
    default:
      return {};
  }
}

void describe_deep(const ChannelIndex& index, const ChannelGroup& color, LayerRule rule, Subject& subject) {
  const FileHeader& file = index.files[std::size_t(color.file)];
  const Part& part = file.parts[std::size_t(color.part)];
  const DeepChannels channels = deep_channels(part);
  const std::string where =
      file.parts.size() < 2 || part.name.empty() ? "the file is deep" : "part " + part.name + " is deep";
  const bool coverage = channels.opacity[3] || channels.colored;
  subject.notes.push_back(
      "color: " + where + "; its samples are put in order by " +
      (channels.z ? channels.z_back ? "Z and ZBack, volumes split where they overlap, " : "Z, "
                  : "their places in the file, for there is no Z, ") +
      "and flattened" + (coverage ? "" : "; there is no alpha, so the nearest one hides all others") +
      "; motion, depth and ids are those of the sample " +
      (rule == LayerRule::variation ? "across which transmittance changes most" : "that adds most light"));
  if (subject.depth &&
      index.files[std::size_t(subject.depth->file)].parts[std::size_t(subject.depth->part)].name == part.name)
    subject.background_depth = double(deep_background(index.channel(*subject.depth).type));
}

}  // namespace varve
