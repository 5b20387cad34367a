#include "stages/measure_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "base/json.h"
#include "plan/value.h"

namespace varve {
namespace {

/// A figure and how it is shown. The table of figures feeds text, JSON and CSV.
struct Column {
  const char *name, *head;  ///< in JSON and CSV; in the table, "" when it is not there
  int width;
  const char* format;
  double (*value)(const SettingFigures&);
};

constexpr Column kColumns[] = {
    {"ms_per_frame", "ms/frame", 9, "%.1f", [](const SettingFigures& f) { return 1e3 * f.seconds; }},
    {"cpu_ms_per_frame", "", 0, "%.1f", [](const SettingFigures& f) { return 1e3 * f.cpu_seconds; }},
    {"megapixels_per_second", "MP/s", 7, "%.2f", [](const SettingFigures& f) { return 1e-6 * f.pixels_per_second; }},
    {"ratio_to_baseline", "x base", 7, "%.2f", [](const SettingFigures& f) { return f.to_baseline; }},
    {"ratio_to_floor", "x floor", 8, "%.2f", [](const SettingFigures& f) { return f.to_floor; }},
    {"peak_mib", "MiB", 6, "%.0f", [](const SettingFigures& f) { return f.peak_mib; }},
    {"psnr_tone", "PSNR dB", 8, "%.2f", [](const SettingFigures& f) { return f.psnr_tone; }},
    {"flip", "FLIP", 8, "%.4f", [](const SettingFigures& f) { return f.flip; }},
    {"flicker", "flicker", 9, "%.2e", [](const SettingFigures& f) { return f.flicker; }},
    {"ghost", "ghost", 8, "%.4f", [](const SettingFigures& f) { return f.ghost; }},
    {"sharpness", "sharp", 7, "%.3f", [](const SettingFigures& f) { return f.sharpness; }},
    {"left_out_db", "left out", 9, "%.2f", [](const SettingFigures& f) { return f.leave_out; }},
    {"unsteady", "unsteady", 10, "%.3e", [](const SettingFigures& f) { return f.unsteady; }},
    {"not_finite", "not fin.", 9, "%.0f", [](const SettingFigures& f) { return f.not_finite; }},
};

std::string padded(const std::string& text, int width) {
  return text.size() < std::size_t(width) ? std::string(std::size_t(width) - text.size(), ' ') + text : text;
}

std::string shown(const Column& column, double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 48> text;
  std::snprintf(text.data(), text.size(), column.format, value);
  return text.data();
}

/// Columns with a figure, in blocks that keep the table within 100 columns.
std::vector<std::vector<const Column*>> blocks_of(const Measurement& m, int names) {
  std::vector<std::vector<const Column*>> blocks = {{}};
  int width = names;
  for (const Column& column : kColumns) {
    const bool there = std::ranges::any_of(m.settings, [&](const auto& f) { return !std::isnan(column.value(f)); });
    if (column.width == 0 || !there) continue;
    if (width + column.width > 100) blocks.emplace_back(), width = names;
    blocks.back().push_back(&column);
    width += column.width;
  }
  return blocks;
}

std::string table(const Measurement& m) {
  std::size_t names = 9;
  for (const SettingFigures& f : m.settings) names = std::max(names, f.name.size() + 6);
  names = std::min<std::size_t>(names, 46);
  std::string out;
  for (const auto& block : blocks_of(m, int(names))) {
    out += (out.empty() ? "" : "\n") + std::string("   # setting") + std::string(names > 12 ? names - 12 : 0, ' ');
    for (const Column* column : block) out += padded(column->head, column->width);
    out += "\n";
    for (std::size_t i = 0; i < m.settings.size(); ++i) {
      const SettingFigures& f = m.settings[i];
      std::string line = (f.on_front ? "*" : " ") + padded(std::to_string(i + 1), 3) + " " + f.name;
      // A name that is too long gets a line of its own.
      if (line.size() > names)
        line += "\n" + std::string(names, ' ');
      else
        line.resize(names, ' ');
      out += line;
      for (const Column* column : block) out += padded(shown(*column, column->value(f)), column->width);
      out += "\n";
    }
  }
  return out;
}

std::string quoted(const std::string& word) {
  if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-=./,:%@+#") ==
          std::string::npos &&
      !word.empty() && word[0] != '#')
    return word;
  std::string out = "'";
  for (char ch : word) out += ch == '\'' ? std::string("'\\''") : std::string(1, ch);
  return out + "'";
}

std::string csv_quote(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (char ch : text) out += ch == '"' ? std::string("\"\"") : std::string(1, ch);
  return out + "\"";
}

std::string with_one_decimal(double value) {
  std::array<char, 48> text;
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string recommendation(const Measurement& m, const MeasureJob& job) {
  if (!m.recommended) return "No setting has a score, so none is recommended.\n";
  const SettingFigures& f = m.settings[*m.recommended];
  return "Cheapest within " + number_text(job.within) + " % of the least " +
         (m.with_reference ? "error" : "left-out error") + ": " + f.name + "\n  " + command_line(m, job) + "\n";
}

}  // namespace

std::string command_line(const Measurement& m, const MeasureJob& job) {
  if (!m.recommended) return "";
  std::string line = "varve resolve " + quoted(job.resolve.input.color.text()) + " -o OUT.####.exr";
  for (const auto& words : {job.resolve_words, job.settings[*m.recommended].arguments()})
    for (const std::string& word : words) line += " " + quoted(word);
  return line;
}

std::string measure_text(const Measurement& m, const MeasureJob& job) {
  std::string out = "Frames " + format_frame_list(m.frames) + ", median of " + std::to_string(job.repeats) +
                    (job.repeats == 1 ? " run" : " interleaved runs") + "; reading and writing alone takes " +
                    with_one_decimal(1e3 * m.floor_seconds) + " ms/frame\nBaseline: " + m.settings[m.baseline].name +
                    "; * is on the Pareto front: no other setting is both faster and less wrong\n\n";
  out += table(m) + "\n";
  for (const std::string& note : m.notes) out += "Note: " + note + "\n";
  if (!m.with_reference)
    out +=
        "Without a reference the score ranks, it does not tell how wrong a setting is: \"left out\" is the difference "
        "in dB\n"
        "of each frame, brought along the motion, to the samples of the next one. Their noise is in it.\n";
  if (!std::isnan(m.rank_correlation)) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.3f", m.rank_correlation);
    out += "Rank correlation of the left-out score with that by the reference: " + std::string(text.data()) + "\n";
  }
  return out + recommendation(m, job);
}

std::string measure_csv(const Measurement& m) {
  std::string out = "setting,pareto,recommended";
  for (const Column& column : kColumns) out += "," + std::string(column.name);
  out += "\n";
  for (std::size_t i = 0; i < m.settings.size(); ++i) {
    const SettingFigures& f = m.settings[i];
    out += csv_quote(f.name) + (f.on_front ? ",1" : ",0") + (m.recommended == i ? ",1" : ",0");
    for (const Column& column : kColumns) {
      const double value = column.value(f);
      out += "," + (std::isnan(value) ? std::string() : number_text(value));
    }
    out += "\n";
  }
  return out;
}

std::string measure_json(const Measurement& m, const MeasureJob& job) {
  std::string out = "{\"input\":" + json_quote(job.resolve.input.color.text()) +
                    ",\"reference\":" + (job.reference ? json_quote(job.reference->text()) : "null");
  out += ",\n\"frames\":" + json_quote(format_frame_list(m.frames)) +
         ",\"scored\":" + json_quote(format_frame_list(m.scored)) + ",\"repeats\":" + std::to_string(job.repeats);
  out += ",\n\"floor_ms_per_frame\":" + json_number(1e3 * m.floor_seconds) +
         ",\"floor_peak_mib\":" + json_number(m.floor_mib) + ",\"baseline\":" + json_quote(m.settings[m.baseline].name);
  out += ",\n\"rank_correlation\":" + json_number(m.rank_correlation) +
         ",\n\"recommended\":" + (m.recommended ? json_quote(m.settings[*m.recommended].name) : "null") +
         ",\"command\":" + json_quote(command_line(m, job)) + ",\n\"notes\":[";
  for (std::size_t i = 0; i < m.notes.size(); ++i) out += (i ? "," : "") + json_quote(m.notes[i]);
  out += "],\n\"settings\":[";
  for (std::size_t i = 0; i < m.settings.size(); ++i) {
    const SettingFigures& f = m.settings[i];
    out += std::string(i ? ",\n" : "\n") + "{\"name\":" + json_quote(f.name) +
           ",\"pareto\":" + (f.on_front ? "true" : "false");
    for (const Column& column : kColumns)
      out += ",\"" + std::string(column.name) + "\":" + json_number(column.value(f));
    out += "}";
  }
  return out + "]}\n";
}

}  // namespace varve
