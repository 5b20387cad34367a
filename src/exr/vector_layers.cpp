#include "exr/vector_layers.h"

#include <algorithm>
#include <cstddef>

#include "exr/channel_index.h"

namespace varve {
namespace {

// In which order channels of a vector are meant; others follow as they are stored.
std::size_t rank_of(std::string_view base) {
  constexpr std::string_view kOrder[] = {"x",   "y", "z",     "w", "u",    "v", "r",
                                         "red", "g", "green", "b", "blue", "a", "alpha"};
  return std::size_t(std::find(std::begin(kOrder), std::end(kOrder), base) - std::begin(kOrder));
}

VectorLayer layer_of(const ChannelIndex& index, const ChannelGroup& group, std::vector<ChannelGroup::Member> members,
                     bool by_name) {
  std::stable_sort(members.begin(), members.end(),
                   [](const auto& a, const auto& b) { return rank_of(a.base) < rank_of(b.base); });
  VectorLayer layer{join_path(group.path), by_name, {}, {}};
  for (std::size_t i = 0; i < std::min<std::size_t>(members.size(), 4); ++i) {
    layer.channels.push_back(members[i].ref);
    layer.names.push_back(index.name(members[i].ref));
  }
  return layer;
}

bool is_color_of(const Subject& subject, ChannelRef ref) {
  return std::any_of(subject.color.begin(), subject.color.end(), [&](const auto& c) { return c && *c == ref; });
}

// Channels of a group that look like motion by their own names, or all of them if the layer's name says so.
std::vector<ChannelGroup::Member> motion_members(const ChannelIndex& index, const ChannelGroup& group) {
  std::vector<ChannelGroup::Member> members;
  for (const ChannelGroup::Member& member : group.members)
    if (member.type != PixelType::uint32 && classify(index.channel(member.ref)) == ChannelClass::motion)
      members.push_back(member);
  if (!members.empty() || group.holds() != ChannelClass::motion) return members;
  for (const ChannelGroup::Member& member : group.members)
    if (member.type != PixelType::uint32) members.push_back(member);
  return members;
}

// Nothing that is known to be something else.
bool may_be_anything(const ChannelIndex& index, const ChannelGroup& group, const Subject& subject) {
  if (group.members.size() < 2 || group.members.size() > 4) return false;
  return std::all_of(group.members.begin(), group.members.end(), [&](const ChannelGroup::Member& member) {
    if (member.type == PixelType::uint32 || is_color_of(subject, member.ref)) return false;
    switch (classify(index.channel(member.ref))) {
      case ChannelClass::depth:
      case ChannelClass::normal:
      case ChannelClass::position:
      case ChannelClass::uv:
      case ChannelClass::id:
      case ChannelClass::cryptomatte:
        return false;
      default:
        return true;
    }
  });
}

// The layer that vectors of that name belong to: "fg" for "fg.Vector".
std::string owner_of(const ChannelGroup& group) {
  const bool by_layer = group.holds() == ChannelClass::motion && !group.path.empty();
  return join_path(std::span(group.path).first(group.path.size() - (by_layer ? 1 : 0)));
}

bool serves(const std::string& owner, const std::string& layer) {
  return owner.empty() || owner == layer || layer.starts_with(owner + ".");
}

}  // namespace

std::vector<VectorLayer> vector_layers(std::span<const FileHeader> files, const Subject& subject) {
  const ChannelIndex index = index_channels(files);
  std::vector<VectorLayer> own, foreign, any;
  for (const ChannelGroup& group : index.groups) {
    if (!index.views_match(subject.view, group.view)) continue;
    if (const std::vector<ChannelGroup::Member> members = motion_members(index, group); members.size() >= 2)
      (serves(owner_of(group), subject.layer) ? own : foreign).push_back(layer_of(index, group, members, true));
    else if (may_be_anything(index, group, subject))
      any.push_back(layer_of(index, group, group.members, false));
  }
  // An owner of its own goes before vectors of everything.
  const auto closer = [&](const VectorLayer& layer) {
    return !subject.layer.empty() && layer.name.starts_with(subject.layer + ".");
  };
  if (std::any_of(own.begin(), own.end(), closer))
    std::erase_if(own, [&](const VectorLayer& layer) { return !closer(layer); });
  if (!own.empty()) return own;
  return foreign.empty() ? any : foreign;
}

}  // namespace varve
