#include "plan/describe.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/words.h"

namespace varve {
namespace {

/// Lines of columns that take the width of their widest entry; the last column is wrapped.
class Table {
 public:
  explicit Table(std::size_t indent) : indent_(indent) {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  std::string text() const {
    std::vector<std::size_t> widths;
    for (const std::vector<std::string>& row : rows_)
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (i == widths.size()) widths.push_back(0);
        widths[i] = std::max(widths[i], row[i].size());
      }
    std::string text;
    for (const std::vector<std::string>& row : rows_) {
      std::string line(indent_, ' ');
      for (std::size_t i = 0; i + 1 < row.size(); ++i) line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
      if (!row.empty()) text += wrapped(line, row.back());
    }
    return text;
  }

 private:
  std::size_t indent_;
  std::vector<std::vector<std::string>> rows_;
};

std::string number(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string window_text(const Window& w) {
  return std::to_string(w.width()) + "x" + std::to_string(w.height()) + " at " + std::to_string(w.x0) + "," +
         std::to_string(w.y0);
}

std::string memory_text(std::size_t bytes) { return std::to_string((bytes + (std::size_t(1) << 19)) >> 20) + " MiB"; }

std::string time_text(double seconds) { return seconds < 1 ? number(seconds * 1000) + " ms" : number(seconds) + " s"; }

// As everywhere: the part is named where a file has several.
std::string shown_name(const SequenceInfo& info, const ChannelStatistics& s) {
  const bool several = std::any_of(info.first.files.begin(), info.first.files.end(),
                                   [](const FileHeader& file) { return file.parts.size() > 1; });
  return (several && !s.part.empty() ? s.part + ":" : "") + s.channel;
}

std::string sequence_text(const SequenceInfo& info) {
  Table table(2);
  table.add({"frames", format_frame_list(info.frames) + " (" + std::to_string(info.frames.size()) + ")"});
  table.add({"missing", info.gaps.empty() ? "none" : format_frame_list(info.gaps)});
  table.add({"jitter", info.jitter_source});
  table.add({"camera", info.camera});
  return "Sequence\n" + table.text();
}

std::string files_text(const SequenceInfo& info, const Plan& plan) {
  std::string text;
  const std::vector<FileHeader>& files = files_on_disk(info.first);
  for (int f = 0; f < int(files.size()); ++f) {
    const FileHeader& file = files[std::size_t(f)];
    text += "\n" + file.path + "\n";
    for (int p = 0; p < int(file.parts.size()); ++p) {
      const Part& part = file.parts[std::size_t(p)];
      const std::string title = std::string(name_of(part.storage)) + ", " + name_of(part.compression) + ", data " +
                                window_text(part.data_window) + ", display " + window_text(part.display_window) +
                                (part.view.empty() ? "" : ", view " + part.view);
      text +=
          wrapped("  part " + std::to_string(p) + (part.name.empty() ? "" : " \"" + part.name + "\"") + ": ", title);
      Table table(4);
      for (int c = 0; c < int(part.channels.size()); ++c) {
        const Channel& channel = part.channels[std::size_t(c)];
        const ChannelRef ref{f, p, c};
        const bool read = std::find(plan.channels.begin(), plan.channels.end(), ref) != plan.channels.end();
        const std::string roles = roles_of(info, ref);
        table.add({channel.name, name_of(channel.type), name_of(classify(channel)),
                   roles.empty() ? "" : roles + (read ? "" : " (not needed)")});
      }
      text += table.text();
    }
  }
  return text;
}

std::string layers_text(const SequenceInfo& info) {
  Table table(2);
  for (const Subject& subject : info.first.subjects) {
    std::string what = subject.depth ? "depth" : "no depth";
    if (subject.backward || subject.forward)
      what += std::string(", vectors to the ") + (subject.backward ? "previous" : "next") + " frame, convention " +
              subject.convention;
    else
      what += ", no vectors";
    table.add(
        {subject.layer.empty() ? "(main)" : subject.layer, subject.view.empty() ? "" : "view " + subject.view, what});
  }
  return "\nLayers to resolve\n" + table.text();
}

std::string plan_text(const Plan& plan) {
  Table table(2);
  for (const PlannedPass& pass : plan.passes) table.add({pass.name, pass.runs ? "runs" : "-", pass.reason});
  std::string text = "\nPlan\n" + table.text();
  text += "  Estimate: " + memory_text(plan.bytes) + " of memory, " + time_text(plan.seconds_per_frame) +
          " a frame (from constants measured on another machine)\n";
  return text;
}

std::string statistics_text(const SequenceInfo& info, const std::vector<ChannelStatistics>& statistics) {
  if (statistics.empty()) return "";
  Table table(2);
  table.add({"frame", "channel", "role", "least", "greatest", "mean", "not finite", "zero"});
  for (const ChannelStatistics& s : statistics)
    table.add({std::to_string(s.frame), shown_name(info, s), s.role, number(s.least), number(s.greatest),
               number(s.mean), std::to_string(s.not_finite),
               s.pixels == 0 ? "-" : number(100.0 * double(s.zero) / double(s.pixels)) + " %"});
  return "\nPixels\n" + table.text();
}

std::string list_text(const std::string& title, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  std::string text = "\n" + title + "\n";
  for (const std::string& sentence : sentences) text += wrapped("  - ", sentence);
  return text;
}

bool is_vector(const ChannelStatistics& s) { return s.role.starts_with("motion.") || s.role.starts_with("forward."); }

PixelType type_of(const SequenceInfo& info, const ChannelStatistics& s) {
  for (const FileHeader& file : info.first.files)
    for (const Part& part : file.parts)
      for (const Channel& channel : part.channels)
        if (part.name == s.part && channel.name == s.channel) return channel.type;
  return PixelType::float32;
}

/// All frames of one vector channel together.
struct VectorSummary {
  std::string name;
  PixelType type = PixelType::float32;
  double least = 0, greatest = 0;
  std::size_t pixels = 0, finite = 0, zero = 0;
};

std::vector<VectorSummary> summarize_vectors(const SequenceInfo& info,
                                             const std::vector<ChannelStatistics>& statistics) {
  std::vector<VectorSummary> all;
  for (const ChannelStatistics& s : statistics) {
    if (!is_vector(s)) continue;
    const std::string name = shown_name(info, s);
    auto found = std::find_if(all.begin(), all.end(), [&](const VectorSummary& v) { return v.name == name; });
    if (found == all.end()) found = all.insert(all.end(), {name, type_of(info, s), s.least, s.greatest, 0, 0, 0});
    found->least = std::min(found->least, s.least);
    found->greatest = std::max(found->greatest, s.greatest);
    found->pixels += s.pixels;
    found->finite += s.pixels - s.not_finite;
    found->zero += s.zero;
  }
  return all;
}

}  // namespace

std::string roles_of(const SequenceInfo& info, ChannelRef ref) {
  constexpr const char* kColor[] = {"R", "G", "B", "A"};
  std::string text;
  for (const Subject& s : info.first.subjects) {
    std::string role;
    const auto take = [&](const std::optional<ChannelRef>& channel, const char* name) {
      if (channel && *channel == ref) role.append(role.empty() ? "" : "+").append(name);
    };
    for (std::size_t i = 0; i < 4; ++i) take(s.color[i], kColor[i]);
    for (const Companion& companion : s.companions)
      for (const std::optional<ChannelRef>& channel : companion.channels) take(channel, "companion");
    take(s.depth, "depth");
    take(s.id, "id");
    if (s.normal) take((*s.normal)[0], "normal.x"), take((*s.normal)[1], "normal.y"), take((*s.normal)[2], "normal.z");
    take(s.reactive, "reactive");
    take(s.responsive, "responsive");
    if (s.transmittance && std::ranges::find(s.transmittance->channels, ref) != s.transmittance->channels.end())
      role.append(role.empty() ? "" : "+").append("transmittance");
    if (s.backward) take((*s.backward)[0], "motion.x"), take((*s.backward)[1], "motion.y");
    if (s.forward) take((*s.forward)[0], "forward.x"), take((*s.forward)[1], "forward.y");
    if (role.empty()) continue;
    const std::string of = info.first.subjects.size() < 2 ? ""
                           : s.view.empty()               ? s.layer
                           : s.layer.empty()              ? s.view
                                                          : s.layer + "." + s.view;
    text += (text.empty() ? "" : ", ") + (of.empty() ? "" : of + " ") + role;
  }
  return text;
}

std::vector<std::string> findings(const SequenceInfo& info, const std::vector<ChannelStatistics>& statistics) {
  std::vector<std::string> found;
  const std::vector<VectorSummary> vectors = summarize_vectors(info, statistics);
  const auto still = [](const VectorSummary& v) { return v.pixels > 0 && v.zero == v.pixels; };
  if (!vectors.empty() && std::all_of(vectors.begin(), vectors.end(), still))
    found.push_back(
        "every vector is zero: nothing moves, or the renderer wrote no vectors (Cycles does so when motion blur is "
        "on)");
  for (const VectorSummary& v : vectors) {
    const double longest = std::max(std::abs(v.least), std::abs(v.greatest));
    if (v.finite == 0 || still(v)) continue;
    if (v.least == v.greatest)
      found.push_back(v.name + " is " + number(v.least) +
                      " everywhere: a bias that the convention does not know, or a plain pan");
    if (longest > 16384)
      found.push_back(v.name + " reaches " + number(longest) +
                      ": too long for pixels; the convention or the unit is wrong, or background is marked so");
    if (v.type == PixelType::float16 && longest >= 32 && longest <= 16384)
      found.push_back(v.name + " is stored as half and reaches " + number(longest) + ", where its step is " +
                      number(std::exp2(std::floor(std::log2(longest)) - 10)));
  }
  for (const ChannelStatistics& s : statistics)
    if (s.not_finite > 0)
      found.push_back("frame " + std::to_string(s.frame) + ": " + shown_name(info, s) + " has " +
                      std::to_string(s.not_finite) + " pixels that are not finite");
  return found;
}

std::string describe_text(const SequenceInfo& info, const Plan& plan,
                          const std::vector<ChannelStatistics>& statistics) {
  std::vector<std::string> notes = plan.notes;
  notes.insert(notes.end(), info.notes.begin(), info.notes.end());
  return sequence_text(info) + files_text(info, plan) + layers_text(info) + plan_text(plan) +
         statistics_text(info, statistics) + list_text("Findings", findings(info, statistics)) +
         list_text("Notes", notes);
}

}  // namespace varve
