// The further layers and channels of --channels: light groups, occlusion, shadows, reflections.

#include <algorithm>
#include <array>

#include "base/error.h"
#include "exr/channel_index.h"

namespace varve {
namespace {

constexpr std::array<std::array<std::string_view, 2>, 4> kPlaces = {
    {{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}}};

/// A chosen channel with the layer it lies in.
struct Chosen {
  const ChannelGroup* group = nullptr;
  const ChannelGroup::Member* member = nullptr;
};

bool is_pattern(std::string_view name) { return name.find_first_of("*?") != std::string_view::npos; }

// * stands for any number of characters, ? for one. Both texts in lower case. Goes back to the last star only, so the
// time is bounded by the product of the lengths.
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p, ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

// The whole name, or what follows one of its dots or the part: "AO" is meant by "ViewLayer.AO" as well.
bool answers(const std::string& pattern, const std::string& name) {
  const std::string text = lower_case(name);
  if (matches(pattern, text)) return true;
  for (std::size_t at = text.find_first_of(".:"); at != std::string::npos; at = text.find_first_of(".:", at + 1))
    if (matches(pattern, std::string_view(text).substr(at + 1))) return true;
  return false;
}

std::string layer_name(const ChannelGroup& group) { return join_path(group.path); }

/// Why a channel must not be averaged; "" if it may be.
std::string reason_against(const ChannelIndex& index, const Chosen& c) {
  const Channel& channel = index.channel(c.member->ref);
  const std::string passes = "; it passes through as it is, leave it out of --channels";
  if (channel.x_sampling != 1 || channel.y_sampling != 1)
    return "is subsampled, it has no value at every pixel" + passes;
  switch (const ChannelClass kind = classify(channel)) {
    case ChannelClass::cryptomatte:
    case ChannelClass::id:
      return std::string("holds ids, and the mean of two ids is a third one") + passes;
    case ChannelClass::depth:
    case ChannelClass::position:
    case ChannelClass::uv:
    case ChannelClass::normal:
    case ChannelClass::motion:
      return std::string("holds a ") + name_of(kind) +
             ", and the mean of two surfaces lies on neither; only light and coverage can be averaged" + passes;
    case ChannelClass::color:
    case ChannelClass::alpha:
    case ChannelClass::other:
      break;
  }
  // What no table knows: axes give a vector away, and a name may say what it holds.
  if (c.group->find("x") && c.group->find("y"))
    return "lies in a layer with the axes X and Y, so it is a vector, which is never averaged" + passes;
  if (lower_case(channel.name).find("depth") != std::string::npos)
    return "holds a depth by its name, and the mean of two surfaces lies on neither" + passes;
  return "";
}

bool is_color_of(const Subject& subject, ChannelRef ref) {
  return std::any_of(subject.color.begin(), subject.color.end(), [&](const auto& c) { return c && *c == ref; });
}

// What a name or a pattern leads to, in file order; never nothing. A layer gives what can be resolved of it.
std::vector<Chosen> choose(const ChannelIndex& index, const std::string& name, const std::vector<Subject>& subjects,
                           std::string& left_out) {
  const std::string wanted = lower_case(name);
  const std::string what = index.files.front().path + ": --channels " + name + ": ";
  std::vector<Chosen> chosen;
  std::string refused;
  for (const ChannelGroup& group : index.groups) {
    if (group.file != 0) continue;
    const bool whole = !group.path.empty() && answers(wanted, layer_name(group));
    for (const std::vector<ChannelGroup::Member>* members : {&group.members, &group.subsampled})
      for (const ChannelGroup::Member& member : *members) {
        if (!whole && !answers(wanted, index.name(member.ref))) continue;
        const Chosen candidate{&group, &member};
        std::string against = reason_against(index, candidate);
        if (against.empty() &&
            std::any_of(subjects.begin(), subjects.end(), [&](const Subject& s) { return is_color_of(s, member.ref); }))
          against = "is resolved already, as a color of --layer; leave it out of --channels";
        if (against.empty()) {
          chosen.push_back(candidate);
          continue;
        }
        if (refused.empty()) refused = "the channel " + index.name(member.ref) + " " + against;
        if (!whole && !is_pattern(name)) throw Failure(ExitCode::inconsistent, what + refused);
        left_out += (left_out.empty() ? "" : ", ") + index.name(member.ref);
      }
  }
  if (!chosen.empty()) return chosen;
  throw Failure(
      ExitCode::inconsistent,
      what + (refused.empty() ? "there is no layer or channel of that name; varve probe lists them" : refused));
}

/// A channel's place among R, G, B and A by its name; -1 if it has none.
int place_of(const Chosen& c) {
  for (std::size_t k = 0; k < 4; ++k)
    for (const std::string_view base : kPlaces[k])
      if (c.member->base == base) return int(k);
  return -1;
}

// Colors by layer, then the values that stand alone, four to a companion.
std::vector<Companion> make_companions(const std::vector<Chosen>& chosen) {
  std::vector<Companion> colors, values;
  const ChannelGroup* last = nullptr;
  std::size_t free = 4;
  for (const Chosen& c : chosen) {
    const int place = place_of(c);
    const bool taken = place >= 0 && last == c.group && colors.back().channels[std::size_t(place)];
    if (place >= 0 && !taken) {
      if (last != c.group) colors.push_back({layer_name(*c.group), true, {}});
      last = c.group;
      colors.back().channels[std::size_t(place)] = c.member->ref;
      continue;
    }
    if (free == 4) {
      values.push_back({"", false, {}});
      free = 0;
    }
    values.back().channels[free++] = c.member->ref;
  }
  colors.insert(colors.end(), values.begin(), values.end());
  return colors;
}

// The subject of the view whose layer the channel lies in, the most particular one; else the first of the view.
std::size_t owner_of(const ChannelIndex& index, const std::vector<Subject>& subjects, std::size_t count,
                     const ChannelGroup& group) {
  std::size_t best = count, length = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!index.views_match(subjects[i].view, group.view)) continue;
    const std::string layer = lower_case(subjects[i].layer);
    const bool belongs = !layer.empty() && lower_case(layer_name(group)).starts_with(layer + ".");
    if (best == count || (belongs && layer.size() > length)) best = i;
    if (belongs) length = std::max(length, layer.size());
  }
  return best;
}

std::string names_of(const ChannelIndex& index, const std::vector<Chosen>& chosen) {
  std::string names;
  for (const Chosen& c : chosen) names += (names.empty() ? "" : ", ") + index.name(c.member->ref);
  return names;
}

// A subject with the motion and the depth of another one.
Subject lone_subject(const ChannelIndex& index, const Subject& color, const Companion& companion, std::size_t place) {
  Subject subject = color;
  subject.companions.clear();
  subject.notes.clear();
  subject.layer = companion.layer;
  subject.color = companion.channels;
  if (!companion.color) {
    subject.layer = index.name(*companion.channels[place]);
    subject.color = {std::nullopt, companion.channels[place], std::nullopt, std::nullopt};
  }
  subject.notes.push_back(subject.layer + ": resolved by its own neighborhood, with motion and depth of " +
                          (color.layer.empty() ? "the main layer" : "layer " + color.layer));
  return subject;
}

}  // namespace

std::vector<int> parts_of(const Subject& subject) {
  std::vector<int> parts = {part_of(subject)};
  for (const Companion& companion : subject.companions)
    for (const std::optional<ChannelRef>& channel : companion.channels)
      if (channel) parts.push_back(channel->part);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

void add_channels(const ChannelIndex& index, const RoleRequest& request, std::vector<Subject>& subjects) {
  if (request.channels.empty()) return;
  std::vector<Chosen> chosen;
  std::string left_out;
  for (const std::string& name : request.channels)
    for (const Chosen& c : choose(index, name, subjects, left_out)) {
      const auto same = [&](const Chosen& other) { return other.member == c.member; };
      if (std::none_of(chosen.begin(), chosen.end(), same)) chosen.push_back(c);
    }
  // File order, so that the channels of a layer stand together however they were named.
  std::sort(chosen.begin(), chosen.end(), [&](const Chosen& a, const Chosen& b) {
    return a.group != b.group ? a.group < b.group : a.member->ref.channel < b.member->ref.channel;
  });
  const std::size_t count = subjects.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Chosen> mine;
    for (const Chosen& c : chosen)
      if (owner_of(index, subjects, count, *c.group) == i) mine.push_back(c);
    if (mine.empty()) continue;
    std::vector<Companion> companions = make_companions(mine);
    if (request.channel_weights == ChannelWeights::beauty) {
      subjects[i].companions = std::move(companions);
      subjects[i].notes.push_back("channels: " + names_of(index, mine) + " are resolved by the weights of " +
                                  (subjects[i].layer.empty() ? "the main layer" : "layer " + subjects[i].layer));
      continue;
    }
    for (const Companion& companion : companions)
      for (std::size_t k = 0; k < (companion.color ? 1u : 4u); ++k)
        if (companion.color || companion.channels[k])
          subjects.push_back(lone_subject(index, Subject(subjects[i]), companion, k));
  }
  for (const Chosen& c : chosen)
    if (owner_of(index, subjects, count, *c.group) == count)
      throw Failure(ExitCode::inconsistent, index.files.front().path + ": --channels: the channel " +
                                                index.name(c.member->ref) +
                                                " lies in a view of which no color is resolved; name the view's layer "
                                                "with --layer");
  if (!left_out.empty())
    subjects.front().notes.push_back("channels: " + left_out +
                                     " lie in what --channels names, but are left as they are: resolved already, or "
                                     "not to be averaged");
}

}  // namespace varve
