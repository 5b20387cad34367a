#include "exr/channel_index.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/error.h"

namespace varve {
namespace {

bool same(std::string_view a, std::string_view b) { return lower_case(a) == lower_case(b); }

// What the name of a part adds to the layer path: nothing where there is only one part to speak of.
std::vector<std::string> part_path(const FileHeader& file, const Part& part) {
  if (file.parts.size() < 2 || part.name.empty()) return {};
  std::vector<std::string> path = split_at_dots(part.name);
  if (!part.view.empty() && !path.empty() && path.back() == part.view) path.pop_back();
  return path;
}

bool repeats(const std::vector<std::string>& layers, const std::vector<std::string>& part) {
  return layers.size() >= part.size() && std::equal(part.begin(), part.end(), layers.begin(), same);
}

struct PlacedName {
  std::string view, base;
  std::vector<std::string> path;
  std::size_t part_elements = 0;
};

PlacedName place(const FileHeader& file, const Part& part, const std::vector<std::string>& from_part,
                 const std::string& name) {
  PlacedName placed;
  std::vector<std::string> layers = split_at_dots(name);
  placed.base = lower_case(layers.back());
  layers.pop_back();
  if (!part.view.empty()) {
    placed.view = part.view;
    if (!layers.empty() && layers.back() == part.view) layers.pop_back();
  } else if (!file.multi_view.empty()) {
    // The view is the element just before the channel; plain names, and names without a view, are the default view's.
    placed.view = file.multi_view.front();
    if (!layers.empty() && std::count(file.multi_view.begin(), file.multi_view.end(), layers.back()) > 0) {
      placed.view = layers.back();
      layers.pop_back();
    }
  }
  if (!repeats(layers, from_part)) {
    placed.path = from_part;
    placed.part_elements = from_part.size();
  }
  placed.path.insert(placed.path.end(), layers.begin(), layers.end());
  return placed;
}

std::vector<std::string> views_of(const FileHeader& file) {
  std::vector<std::string> views = file.multi_view;
  for (const Part& part : file.parts)
    if (!part.view.empty() && std::count(views.begin(), views.end(), part.view) == 0) views.push_back(part.view);
  return views;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return lower;
}

std::vector<std::string> split_at_dots(std::string_view name) {
  std::vector<std::string> elements;
  for (;;) {
    const std::size_t dot = name.find('.');
    elements.emplace_back(name.substr(0, dot));
    if (dot == std::string_view::npos) return elements;
    name.remove_prefix(dot + 1);
  }
}

std::string join_path(std::span<const std::string> path) {
  std::string text;
  for (const std::string& element : path) text += (text.empty() ? "" : ".") + element;
  return text;
}

std::optional<ChannelRef> ChannelGroup::find(std::string_view base) const {
  for (const Member& member : members)
    if (member.base == base && member.type != PixelType::uint32) return member.ref;
  return std::nullopt;
}

std::optional<ChannelClass> ChannelGroup::holds() const {
  for (const std::string& element : path)
    if (class_of_layer(element) == ChannelClass::cryptomatte) return ChannelClass::cryptomatte;
  return path.empty() ? std::nullopt : class_of_layer(path.back());
}

bool ChannelIndex::views_match(const std::string& a, const std::string& b) const {
  return a == b || ((a.empty() || b.empty()) && views.size() <= 1);
}

const Channel& ChannelIndex::channel(ChannelRef ref) const {
  return files[std::size_t(ref.file)].parts[std::size_t(ref.part)].channels[std::size_t(ref.channel)];
}

std::string ChannelIndex::name(ChannelRef ref) const {
  const FileHeader& file = files[std::size_t(ref.file)];
  const Part& part = file.parts[std::size_t(ref.part)];
  const std::string prefix = file.parts.size() > 1 && !part.name.empty() ? part.name + ":" : "";
  return prefix + channel(ref).name;
}

ChannelIndex index_channels(std::span<const FileHeader> files, bool deep) {
  ChannelIndex index{files, {}, {}, deep};
  if (!files.empty()) index.views = views_of(files.front());
  using Key = std::tuple<int, int, std::string, std::vector<std::string>>;
  std::map<Key, std::size_t> known;
  for (int f = 0; f < int(files.size()); ++f) {
    const FileHeader& file = files[std::size_t(f)];
    for (int p = 0; p < int(file.parts.size()); ++p) {
      const Part& part = file.parts[std::size_t(p)];
      if (is_deep(part) && !deep) continue;
      const std::vector<std::string> from_part = part_path(file, part);
      for (int c = 0; c < int(part.channels.size()); ++c) {
        const Channel& channel = part.channels[std::size_t(c)];
        PlacedName placed = place(file, part, from_part, channel.name);
        const auto [entry, fresh] = known.emplace(Key{f, p, placed.view, placed.path}, index.groups.size());
        if (fresh)
          index.groups.push_back(
              {f, p, std::move(placed.view), std::move(placed.path), placed.part_elements, {}, is_deep(part), {}});
        ChannelGroup& group = index.groups[entry->second];
        const bool whole = channel.x_sampling == 1 && channel.y_sampling == 1;
        (whole ? group.members : group.subsampled).push_back({std::move(placed.base), {f, p, c}, channel.type});
      }
    }
  }
  return index;
}

std::optional<RoleChoice> choose_role(const ChannelIndex& index, const ChannelGroup& color, bool main_color,
                                      std::span<const RoleCandidate> candidates) {
  const auto belongs = [&](const RoleCandidate& c) {
    return c.owner <= color.path.size() &&
           std::equal(c.group->path.begin(), c.group->path.begin() + std::ptrdiff_t(c.owner), color.path.begin(), same);
  };
  const auto rank = [&](const RoleCandidate& c) {
    return std::make_tuple(c.group->file, -std::ptrdiff_t(c.owner), c.group->part != color.part, c.quality);
  };
  std::optional<RoleChoice> best;
  std::vector<const RoleCandidate*> foreign;
  for (const RoleCandidate& c : candidates) {
    if (!index.views_match(color.view, c.group->view)) continue;
    if (!belongs(c))
      foreign.push_back(&c);
    else if (!best || rank(c) < rank(best->candidate))
      best = RoleChoice{c, false};
  }
  if (best) return best;
  // Nothing of this layer. A lone candidate serves if there can be no mistake about whose it is.
  for (const bool in_role_files : {false, true}) {
    if (!in_role_files && !main_color) continue;
    std::vector<const RoleCandidate*> there;
    for (const RoleCandidate* c : foreign)
      if ((c->group->file > 0) == in_role_files) there.push_back(c);
    if (there.size() == 1) return RoleChoice{*there.front(), true};
  }
  return std::nullopt;
}

std::optional<ChannelRef> mapped_channel(const ChannelIndex& index, const RoleRequest& request, std::string_view role,
                                         int preferred_part, bool integers) {
  const auto asked =
      std::find_if(request.map.begin(), request.map.end(), [&](const auto& m) { return m.first == role; });
  if (asked == request.map.end()) return std::nullopt;
  std::optional<ChannelRef> found;
  for (int f = 0; f < int(index.files.size()); ++f) {
    const std::vector<Part>& parts = index.files[std::size_t(f)].parts;
    for (int p = 0; p < int(parts.size()); ++p)
      for (int c = 0; c < int(parts[std::size_t(p)].channels.size()); ++c) {
        const ChannelRef ref{f, p, c};
        if (asked->second != parts[std::size_t(p)].channels[std::size_t(c)].name && asked->second != index.name(ref))
          continue;
        if (!found || (f == 0 && p == preferred_part && found->part != preferred_part)) found = ref;
      }
  }
  const std::string what = "--map " + asked->first + "=" + asked->second + ": ";
  if (!found) throw Failure(ExitCode::inconsistent, what + "there is no such channel; varve probe lists the channels");
  const Channel& channel = index.channel(*found);
  if (channel.x_sampling != 1 || channel.y_sampling != 1)
    throw Failure(ExitCode::inconsistent,
                  what + "the channel is subsampled; only channels with every pixel can be used");
  if (is_deep(index.files[std::size_t(found->file)].parts[std::size_t(found->part)]) && !index.deep)
    throw Failure(ExitCode::inconsistent, what +
                                              "the channel is in a deep part, and the color is in a flat one; "
                                              "choose the deep part with --layer");
  if (channel.type == PixelType::uint32 && !integers)
    throw Failure(ExitCode::inconsistent, what + "the channel holds integers, which are never filtered");
  return found;
}

}  // namespace varve
