#include "stages/comparison_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/json.h"
#include "plan/value.h"

namespace varve {
namespace {

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string label(const Metric& metric) {
  return std::string(metric.name) + (metric.unit.empty() ? "" : " [" + std::string(metric.unit) + "]");
}

/// The figures that a frame has, as a table with a line for each frame. Blocks of columns keep it within 100.
std::string frame_table(const Comparison& c, const ComparisonRow& row) {
  std::vector<MetricId> columns;
  for (MetricId id : metrics_present(c))
    if (std::ranges::any_of(row.frames, [id](const MetricValues& v) { return !std::isnan(v[id]); }))
      columns.push_back(id);
  std::string out;
  constexpr std::size_t per_block = 8;
  for (std::size_t first = 0; first < columns.size(); first += per_block) {
    const std::size_t last = std::min(first + per_block, columns.size());
    out += padded("frame", 8);
    for (std::size_t k = first; k < last; ++k) out += padded(std::string(metric_of(columns[k]).name), 11);
    out += "\n";
    for (std::size_t i = 0; i < row.frames.size(); ++i) {
      out += padded(std::to_string(c.frames[i]), 8);
      for (std::size_t k = first; k < last; ++k) out += padded(figure_text(columns[k], row.frames[i][columns[k]]), 11);
      out += "\n";
    }
    out += padded("all", 8);
    for (std::size_t k = first; k < last; ++k) out += padded(figure_text(columns[k], row.sequence[columns[k]]), 11);
    out += "\n";
  }
  return out;
}

/// Figures of the whole sequence alone.
std::string sequence_lines(const ComparisonRow& row) {
  std::string out;
  for (const Metric& metric : metrics()) {
    if (metric.scope != MetricScope::sequence || std::isnan(row.sequence[metric.id])) continue;
    const std::string name = label(metric);
    out += "  " + name + std::string(name.size() < 20 ? 20 - name.size() : 1, ' ') +
           figure_text(metric.id, row.sequence[metric.id]) + "\n";
  }
  return out;
}

std::string channel_table(const Comparison& c) {
  constexpr std::array<MetricId, 5> columns = {MetricId::differing, MetricId::not_finite, MetricId::max, MetricId::mean,
                                               MetricId::rmse};
  std::string out;
  for (const ComparisonRow& row : c.rows) {
    if (row.color) continue;
    if (out.empty()) {
      out = "\nOther channels" + std::string(26, ' ');
      for (MetricId id : columns) out += padded(std::string(metric_of(id).name), 11);
      out += "\n";
    }
    out += "  " + row.name + std::string(row.name.size() < 38 ? 38 - row.name.size() : 1, ' ');
    for (MetricId id : columns) out += padded(figure_text(id, row.sequence[id]), 11);
    out += "\n";
  }
  return out;
}

std::string values_json(const MetricValues& values) {
  std::string out;
  for (const Metric& metric : metrics())
    if (!std::isnan(values[metric.id]))
      out += (out.empty() ? "" : ",") + json_quote(metric.name) + ":" + json_number(values[metric.id]);
  return "{" + out + "}";
}

std::string csv_quote(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (char ch : text) out += ch == '"' ? std::string("\"\"") : std::string(1, ch);
  return out + "\"";
}

std::string csv_line(const std::string& row, const std::string& frame, const MetricValues& values) {
  std::string out = csv_quote(row) + "," + frame;
  for (const Metric& metric : metrics()) {
    out += ",";
    if (!std::isnan(values[metric.id])) out += number_text(values[metric.id]);
  }
  return out + "\n";
}

std::string frames_json(const std::vector<int>& frames) {
  std::string out;
  for (int frame : frames) out += (out.empty() ? "" : ",") + std::to_string(frame);
  return "[" + out + "]";
}

}  // namespace

std::string figure_text(MetricId metric, double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 48> text;
  const bool decibels = metric_of(metric).unit == "dB";
  const bool count = metric == MetricId::differing || metric == MetricId::not_finite || metric == MetricId::missing;
  std::snprintf(text.data(), text.size(), count ? "%.0f" : decibels ? "%.2f" : "%.4g", value);
  return text.data();
}

std::vector<MetricId> metrics_present(const Comparison& c) {
  std::vector<MetricId> present;
  for (const Metric& metric : metrics())
    if (std::ranges::any_of(c.rows, [&](const ComparisonRow& row) {
          return !std::isnan(row.sequence[metric.id]) ||
                 std::ranges::any_of(row.frames, [&](const MetricValues& v) { return !std::isnan(v[metric.id]); });
        }))
      present.push_back(metric.id);
  return present;
}

std::string verdict_sentence(const Comparison& c) {
  switch (c.verdict) {
    case Verdict::equal:
      return "equal: every compared value is the same";
    case Verdict::within:
      return "within: there are differences, all within the limits";
    case Verdict::beyond:
      return std::ranges::any_of(c.broken, [](const LimitResult& r) { return r.limit.fail; })
                 ? "beyond: a limit does not hold"
                 : "beyond: there are differences";
    case Verdict::incomparable:
      return "incomparable: " + c.reason;
  }
  return "";
}

std::vector<std::string> remarks_of(const Comparison& c) {
  std::vector<std::string> remarks;
  for (const LimitResult& r : c.broken) {
    const Metric& metric = metric_of(r.limit.metric);
    std::string text = std::string(r.limit.fail ? "fail: " : "warning: ") + std::string(metric.name);
    if (!r.row.empty()) text += " of " + r.row;
    if (r.by_frame) text += " in frame " + std::to_string(r.frame);
    text += std::isnan(r.value) ? " could not be measured" : " is " + figure_text(r.limit.metric, r.value);
    remarks.push_back(text + ", the limit is " + (metric.better == Better::up ? "at least " : "at most ") +
                      number_text(r.limit.value));
  }
  if (!c.only_a.empty()) remarks.push_back("frames only in A: " + format_frame_list(c.only_a));
  if (!c.only_b.empty()) remarks.push_back("frames only in B: " + format_frame_list(c.only_b));
  for (const FrameFinding& found : c.findings)
    remarks.push_back(std::string(found.finding.kind == FindingKind::note ? "note: " : "difference: ") +
                      found.finding.text + " (frame " + std::to_string(found.frame) +
                      (found.count > 1 ? " and " + std::to_string(found.count - 1) + " more)" : ")"));
  return remarks;
}

std::string comparison_text(const Comparison& c) {
  std::string out = "Verdict  " + verdict_sentence(c) + "\n";
  if (!c.frames.empty())
    out += "Frames   " + format_frame_list(c.frames) + " (" + std::to_string(c.frames.size()) + " in common)\n";
  for (const std::string& remark : remarks_of(c)) out += "  " + remark + "\n";
  if (c.verdict == Verdict::incomparable) return out;
  for (const ComparisonRow& row : c.rows) {
    if (!row.color) continue;
    out += "\nColor " + row.name + "\n" + frame_table(c, row) + sequence_lines(row);
  }
  return out + channel_table(c);
}

std::string comparison_json(const Comparison& c, const CompareJob& job) {
  std::string out = "{\"a\":" + json_quote(job.a.text()) + ",\"b\":" + json_quote(job.b.text());
  out += ",\n\"verdict\":" + json_quote(name_of(c.verdict)) + ",\"sentence\":" + json_quote(verdict_sentence(c));
  out += ",\n\"frames\":" + frames_json(c.frames) + ",\"only_a\":" + frames_json(c.only_a) +
         ",\"only_b\":" + frames_json(c.only_b) + ",\n\"remarks\":[";
  const std::vector<std::string> remarks = remarks_of(c);
  for (std::size_t i = 0; i < remarks.size(); ++i) out += (i ? ",\n" : "\n") + json_quote(remarks[i]);
  out += "],\n\"rows\":[";
  for (std::size_t i = 0; i < c.rows.size(); ++i) {
    const ComparisonRow& row = c.rows[i];
    out += std::string(i ? ",\n" : "\n") + "{\"name\":" + json_quote(row.name) +
           ",\"color\":" + (row.color ? "true" : "false") + ",\"sequence\":" + values_json(row.sequence) +
           ",\n \"frames\":[";
    for (std::size_t k = 0; k < row.frames.size(); ++k)
      out += std::string(k ? ",\n  " : "\n  ") + "{\"frame\":" + std::to_string(c.frames[k]) +
             ",\"metrics\":" + values_json(row.frames[k]) + "}";
    out += "]}";
  }
  return out + "]}\n";
}

std::string comparison_csv(const Comparison& c) {
  std::string out = "row,frame";
  for (const Metric& metric : metrics()) out += "," + std::string(metric.name);
  out += "\n";
  for (const ComparisonRow& row : c.rows) {
    for (std::size_t i = 0; i < row.frames.size(); ++i)
      out += csv_line(row.name, std::to_string(c.frames[i]), row.frames[i]);
    out += csv_line(row.name, "", row.sequence);
  }
  return out;
}

}  // namespace varve
