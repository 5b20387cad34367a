#include "stages/match_channels.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "exr/channel_index.h"

namespace varve {
namespace {

const Part& part_at(const FrameHeaders& headers, ChannelRef ref) {
  return headers.files[std::size_t(ref.file)].parts[std::size_t(ref.part)];
}
const Channel& channel_at(const FrameHeaders& headers, ChannelRef ref) {
  return part_at(headers, ref).channels[std::size_t(ref.channel)];
}

/// With the part in front where there are several, as probe prints it.
std::string full_name(const FrameHeaders& headers, ChannelRef ref) {
  const bool several = headers.files[std::size_t(ref.file)].parts.size() > 1;
  return (several ? part_at(headers, ref).name + ":" : "") + channel_at(headers, ref).name;
}

std::string text_of(const Window& w) {
  return std::to_string(w.x0) + "," + std::to_string(w.y0) + " " + std::to_string(w.width()) + "x" +
         std::to_string(w.height());
}

std::string name_of(const Subject& subject) {
  const std::string layer = subject.layer.empty() ? "main" : subject.layer;
  return subject.view.empty() ? layer : layer + " (" + subject.view + ")";
}

class Matcher {
 public:
  Matcher(const FrameHeaders& a, const FrameHeaders& b, const CompareJob& job) : a_(a), b_(b), job_(job) {}
  FrameMatch match();

 private:
  bool wants(std::string_view what) const { return std::ranges::find(job_.channels, what) != job_.channels.end(); }
  void say(std::string text, FindingKind kind = FindingKind::shape) {
    const Finding finding{std::move(text), kind};
    if (std::ranges::find(match_.findings, finding) == match_.findings.end()) match_.findings.push_back(finding);
  }
  void refuse(const std::string& why) {
    if (match_.incomparable.empty()) match_.incomparable = why;
  }
  Window window_of(ChannelRef a, ChannelRef b, const std::string& where);
  void add_channel(const std::string& name, ChannelRef a, ChannelRef b, bool color);
  void add_subject(std::size_t a, std::size_t b);
  void match_subjects();
  void match_by_name();
  void match_named(const std::string& name);

  const FrameHeaders &a_, &b_;
  const CompareJob& job_;
  FrameMatch match_;
};

/// The pixels to compare; refuses windows that differ.
Window Matcher::window_of(ChannelRef a, ChannelRef b, const std::string& where) {
  const Part &pa = part_at(a_, a), &pb = part_at(b_, b);
  const Window common = intersect(pa.data_window, pb.data_window);
  if (common.empty())
    refuse("the data windows" + where + " do not meet: " + text_of(pa.data_window) + " in A, " +
           text_of(pb.data_window) + " in B");
  if (pa.data_window != pb.data_window) {
    const std::string text = "the data windows" + where + " differ: " + text_of(pa.data_window) + " in A, " +
                             text_of(pb.data_window) + " in B";
    if (!job_.common_window) refuse(text + "; --window common compares where both lie");
    say(text, FindingKind::note);
  }
  if (pa.display_window != pb.display_window) {
    const std::string text = "the display windows" + where + " differ: " + text_of(pa.display_window) + " in A, " +
                             text_of(pb.display_window) + " in B";
    if (!job_.common_window) refuse(text + "; --window common compares nevertheless");
    say(text, FindingKind::note);
  }
  return common;
}

void Matcher::add_channel(const std::string& name, ChannelRef a, ChannelRef b, bool color) {
  const Channel &ca = channel_at(a_, a), &cb = channel_at(b_, b);
  if (ca.x_sampling != cb.x_sampling || ca.y_sampling != cb.y_sampling)
    return say("channel " + name + " is sampled differently in A and B");
  if (ca.type != cb.type)
    say("channel " + name + " is " + varve::name_of(ca.type) + " in A, " + varve::name_of(cb.type) + " in B",
        FindingKind::format);
  const FileHeader& file = a_.files[std::size_t(a.file)];
  const Window window = window_of(a, b, file.parts.size() > 1 ? " of part " + part_at(a_, a).name : "");
  if ((ca.x_sampling != 1 || ca.y_sampling != 1) && part_at(a_, a).data_window != part_at(b_, b).data_window)
    return refuse("channel " + name + " is subsampled and its windows differ");
  match_.channels.push_back({name, a, b, window, color});
}

void Matcher::add_subject(std::size_t ia, std::size_t ib) {
  const Subject &a = a_.subjects[ia], &b = b_.subjects[ib];
  const std::string name = name_of(a);
  const std::size_t before = match_.channels.size();
  for (std::size_t k = 0; k < 4; ++k) {
    if (!a.color[k] && !b.color[k]) continue;
    const std::string channel = a.color[k] ? full_name(a_, *a.color[k]) : full_name(b_, *b.color[k]);
    if (a.color[k] && b.color[k])
      add_channel(channel, *a.color[k], *b.color[k], true);
    else
      say("channel " + channel + " is only in " + (a.color[k] ? "A" : "B"));
  }
  if (match_.channels.size() == before) return refuse("the colors of " + name + " have no channel in common");
  match_.subjects.push_back({ia, ib, name, match_.channels.back().window});
}

/// By layer and view; a lone color against a lone color whatever they are called.
void Matcher::match_subjects() {
  std::vector<bool> used(b_.subjects.size());
  if (a_.subjects.size() == 1 && b_.subjects.size() == 1) return add_subject(0, 0);
  for (std::size_t i = 0; i < a_.subjects.size(); ++i) {
    std::size_t j = 0;
    while (j < used.size() && (used[j] || lower_case(a_.subjects[i].layer) != lower_case(b_.subjects[j].layer) ||
                               a_.subjects[i].view != b_.subjects[j].view))
      ++j;
    if (j == used.size()) {
      say("layer " + name_of(a_.subjects[i]) + " is only in A");
      continue;
    }
    used[j] = true;
    add_subject(i, j);
  }
  for (std::size_t j = 0; j < used.size(); ++j)
    if (!used[j]) say("layer " + name_of(b_.subjects[j]) + " is only in B");
}

bool same_part(const FileHeader& a, const Part& pa, const FileHeader& b, const Part& pb) {
  return a.parts.size() == 1 || b.parts.size() == 1 || pa.name == pb.name;
}

/// Channels that are no color, part by part, by full name.
void Matcher::match_by_name() {
  const FileHeader &fa = a_.files.front(), &fb = b_.files.front();
  const auto is_color = [](const FrameHeaders& headers, ChannelRef ref) {
    return std::ranges::any_of(headers.subjects, [&](const Subject& s) {
      return std::ranges::find(s.color, std::optional(ref)) != s.color.end();
    });
  };
  const auto find = [](const FileHeader& from, const Part& part, const std::string& channel,
                       const FileHeader& in) -> std::optional<ChannelRef> {
    for (std::size_t p = 0; p < in.parts.size(); ++p)
      if (const auto c = in.parts[p].channel(channel);
          c && same_part(from, part, in, in.parts[p]) && !is_deep(in.parts[p]))
        return ChannelRef{0, int(p), *c};
    return std::nullopt;
  };
  const auto each = [&](const FrameHeaders& headers, const auto& use) {
    const FileHeader& file = headers.files.front();
    for (std::size_t p = 0; p < file.parts.size(); ++p) {
      if (is_deep(file.parts[p])) {
        const bool color =
            std::ranges::any_of(headers.subjects, [&](const Subject& s) { return part_of(s) == int(p); });
        say("part " + file.parts[p].name +
            (color ? " is deep; its color is compared flattened, its other channels are not"
                   : " is deep, and deep parts are not compared"));
        continue;
      }
      for (std::size_t c = 0; c < file.parts[p].channels.size(); ++c)
        if (const ChannelRef ref{0, int(p), int(c)}; !is_color(headers, ref)) use(file.parts[p], ref);
    }
  };
  each(a_, [&](const Part& part, ChannelRef ref) {
    const std::string& channel = part.channels[std::size_t(ref.channel)].name;
    const std::string name = full_name(a_, ref);
    if (const auto other = find(fa, part, channel, fb))
      add_channel(name, ref, *other, false);
    else
      say("channel " + name + " is only in A");
  });
  each(b_, [&](const Part& part, ChannelRef ref) {
    const std::string& channel = part.channels[std::size_t(ref.channel)].name;
    if (!find(fb, part, channel, fa)) say("channel " + full_name(b_, ref) + " is only in B");
  });
}

/// One channel by its full name, wherever it is.
void Matcher::match_named(const std::string& name) {
  const auto find = [&](const FrameHeaders& headers) -> std::optional<ChannelRef> {
    const FileHeader& file = headers.files.front();
    for (std::size_t p = 0; p < file.parts.size(); ++p)
      if (const auto c = file.parts[p].channel(name); c && !is_deep(file.parts[p])) return ChannelRef{0, int(p), *c};
    return std::nullopt;
  };
  const auto a = find(a_), b = find(b_);
  if (a && b) return add_channel(name, *a, *b, false);
  if (!a && !b) return refuse("channel " + name + " is in neither A nor B; `varve probe` shows what is there");
  say("channel " + name + " is only in " + (a ? "A" : "B"));
}

FrameMatch Matcher::match() {
  if (wants("color") || wants("all")) match_subjects();
  if (wants("all")) match_by_name();
  for (const std::string& name : job_.channels)
    if (name != "color" && name != "all") match_named(name);
  if (match_.channels.empty()) refuse("A and B have no channel in common that is to be compared");
  if (wants("all") && a_.files.front().parts.size() != b_.files.front().parts.size())
    say("A has " + std::to_string(a_.files.front().parts.size()) + " parts, B has " +
        std::to_string(b_.files.front().parts.size()));
  return std::move(match_);
}

/// Attributes that say when, where and how long, and those told in other ways.
constexpr std::array<std::string_view, 22> kIgnored = {
    "Date",     "Time",   "RenderTime", "DateTime",    "capDate",        "utcOffset",     "File",       "Hostname",
    "Software", "Memory", "channels",   "compression", "dataWindow",     "displayWindow", "chunkCount", "lineOrder",
    "type",     "name",   "version",    "tiles",       "oiio:subimages", "preview"};
/// Likewise, by how the name begins.
constexpr std::array<std::string_view, 3> kIgnoredPrefixes = {"cycles.", "varve:", "blender.render"};

bool is_ignored(std::string_view name) {
  return std::ranges::find(kIgnored, name) != kIgnored.end() ||
         std::ranges::any_of(kIgnoredPrefixes, [&](std::string_view p) { return name.starts_with(p); });
}

}  // namespace

FrameMatch match_channels(const FrameHeaders& a, const FrameHeaders& b, const CompareJob& job) {
  return Matcher(a, b, job).match();
}

std::vector<Finding> compare_attributes(const FileHeader& a, const FileHeader& b) {
  std::vector<Finding> findings;
  for (std::size_t p = 0; p < std::min(a.parts.size(), b.parts.size()); ++p) {
    const std::string where = a.parts.size() > 1 ? " of part " + a.parts[p].name : "";
    for (const Attribute& attribute : a.parts[p].attributes) {
      if (is_ignored(attribute.name)) continue;
      const Attribute* other = b.parts[p].attribute(attribute.name);
      if (!other)
        findings.push_back({"attribute " + attribute.name + where + " is only in A"});
      else if (other->type != attribute.type || other->text != attribute.text || other->numbers != attribute.numbers)
        findings.push_back({"attribute " + attribute.name + where + " differs"});
    }
    for (const Attribute& attribute : b.parts[p].attributes)
      if (!is_ignored(attribute.name) && !a.parts[p].attribute(attribute.name))
        findings.push_back({"attribute " + attribute.name + where + " is only in B"});
  }
  return findings;
}

}  // namespace varve
