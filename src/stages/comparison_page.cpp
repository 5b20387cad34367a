#include "stages/comparison_page.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/version.h"
#include "stages/comparison_text.h"
#include "stages/page_pictures.h"
#include "stages/page_plot.h"

namespace varve {
namespace {

constexpr const char* kStyle = R"(<style>
:root { --ink: #1c2430; --soft: #667; --line: #d9dde3; --back: #f6f7f9; --accent: #2660a4; }
* { box-sizing: border-box; }
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; color: var(--ink); background: var(--back); margin: 0; }
main { max-width: 1080px; margin: 0 auto; padding: 24px; }
h1 { font-size: 22px; margin: 0 0 4px; } h2 { font-size: 17px; margin: 32px 0 10px; }
.soft { color: var(--soft); } code { font-size: 13px; }
.verdict { border-left: 6px solid; padding: 10px 14px; background: #fff; margin: 16px 0; font-weight: 600; }
.equal, .within { border-color: #2a8c4a; } .beyond { border-color: #c33b2e; } .incomparable { border-color: #b37a00; }
table { border-collapse: collapse; background: #fff; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 12px; border-bottom: 1px solid var(--line); text-align: left; }
td b { white-space: nowrap; } td.n, th.n { text-align: right; white-space: nowrap; } th { font-weight: 600; }
.scroll { overflow-x: auto; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 14px; }
.plot { background: #fff; border: 1px solid var(--line); padding: 8px 10px 4px; }
.plot b { font-weight: 600; } svg { width: 100%; height: auto; display: block; }
svg text { font: 10px system-ui, sans-serif; fill: var(--soft); } svg .axis { stroke: var(--line); }
svg .limit { stroke: #c33b2e; stroke-dasharray: 4 3; } svg polyline { fill: none; stroke: var(--accent); stroke-width: 1.5; }
svg circle { fill: var(--accent); }
.frame { background: #fff; border: 1px solid var(--line); padding: 12px; margin-bottom: 16px; display: flex; gap: 16px; flex-wrap: wrap; }
.flip { cursor: pointer; flex: 2 1 560px; } .flip img { width: 100%; image-rendering: pixelated; display: none; }
.flip img.on { display: block; } .whole { flex: 1 1 260px; } .whole img { width: 100%; }
button { font: inherit; border: 1px solid var(--line); background: #fff; padding: 3px 14px; cursor: pointer; }
button.on { background: var(--accent); color: #fff; border-color: var(--accent); }
</style>)";

constexpr const char* kScript = R"(<script>
function show(box, i) {
  box.dataset.i = i;
  box.querySelectorAll("img").forEach((img, k) => img.classList.toggle("on", k === i));
  box.querySelectorAll("button").forEach((b, k) => b.classList.toggle("on", k === i));
}
const boxes = [...document.querySelectorAll(".flip")];
boxes.forEach(box => {
  show(box, 0);
  box.querySelectorAll("button").forEach((b, k) => b.addEventListener("click", e => { e.stopPropagation(); show(box, k); }));
  box.addEventListener("click", () => show(box, +box.dataset.i === 0 ? 1 : 0));
});
document.addEventListener("keydown", e => {
  const k = { a: 0, b: 1, d: 2 }[e.key.toLowerCase()];
  if (k !== undefined) boxes.forEach(box => show(box, k));
  if (e.key === " ") { e.preventDefault(); boxes.forEach(box => show(box, +box.dataset.i === 0 ? 1 : 0)); }
});
</script>)";

std::string escaped(std::string_view text) {
  std::string out;
  for (char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::optional<double> limit_of(const CompareJob& job, MetricId metric) {
  for (const Limit& limit : job.limits)
    if (limit.metric == metric) return limit.value;
  return std::nullopt;
}

/// The frame that is worst by one metric; none when all are alike or unmeasured.
std::string worst_frame(const Comparison& c, const ComparisonRow& row, const Metric& metric) {
  std::optional<std::size_t> worst;
  bool differ = false;
  for (std::size_t i = 0; i < row.frames.size(); ++i) {
    const double value = row.frames[i][metric.id];
    if (std::isnan(value)) continue;
    if (!worst) {
      worst = i;
      continue;
    }
    const double known = row.frames[*worst][metric.id];
    differ = differ || value != known;
    if (metric.better == Better::down ? value > known : value < known) worst = i;
  }
  if (!worst || !differ) return "";
  return figure_text(metric.id, row.frames[*worst][metric.id]) + " in " + std::to_string(c.frames[*worst]);
}

std::string metric_table(const Comparison& c, const CompareJob& job, const ComparisonRow& row) {
  std::string out =
      "<div class='scroll'><table><tr><th>metric</th><th class='n'>all frames</th><th class='n'>worst frame</th>"
      "<th class='n'>limit</th><th>meaning</th></tr>";
  for (MetricId id : metrics_present(c)) {
    const Metric& metric = metric_of(id);
    if (std::isnan(row.sequence[id])) continue;
    const auto limit = limit_of(job, id);
    out += "<tr><td><b>" + std::string(metric.name) + "</b></td><td class='n'>" + figure_text(id, row.sequence[id]) +
           " " + std::string(metric.unit) + "</td><td class='n'>" + worst_frame(c, row, metric) +
           "</td><td class='n'>" + (limit ? figure_text(id, *limit) : "") + "</td><td class='soft'>" +
           escaped(metric.meaning) + "</td></tr>";
  }
  return out + "</table></div>";
}

std::string plots(const Comparison& c, const CompareJob& job, const ComparisonRow& row) {
  if (c.frames.size() < 2) return "";
  std::string out;
  for (MetricId id : metrics_present(c)) {
    std::vector<double> values;
    for (const MetricValues& v : row.frames) values.push_back(v[id]);
    const std::string plot = page_plot(c.frames, values, limit_of(job, id));
    if (plot.empty() || std::ranges::all_of(values, [](double v) { return !(v != 0); })) continue;
    const Metric& metric = metric_of(id);
    out += "<div class='plot'><b>" + std::string(metric.name) + "</b> <span class='soft'>" + std::string(metric.unit) +
           (metric.better == Better::up ? " &uarr; better" : " &darr; better") + "</span>" + plot + "</div>";
  }
  return out.empty() ? "" : "<h2>Over frames</h2><div class='plots'>" + out + "</div>";
}

std::string picture_box(const PagePictures& p) {
  const auto at = [](const Window& w) {
    return std::to_string(w.width()) + " x " + std::to_string(w.height()) + " at " + std::to_string(w.x0) + ", " +
           std::to_string(w.y0);
  };
  return "<div class='frame'><div class='flip'><p><b>Frame " + std::to_string(p.frame) +
         "</b> <button>A</button> <button>B</button> <button>difference</button> <span class='soft'>" + at(p.region) +
         "</span></p><img alt='A' src='" + p.a + "'><img alt='B' src='" + p.b + "'><img alt='difference' src='" +
         p.heat + "'></div><div class='whole'><p class='soft'>Difference in the whole frame, " + at(p.frame_window) +
         "</p><img alt='heat map' src='" + p.whole_heat + "'></div></div>";
}

std::string pictures(const Comparison& c, const CompareJob& job, const std::string& scratch, Workers& workers) {
  if (c.worst.empty() || c.verdict == Verdict::equal) return "";
  if (std::ranges::none_of(c.rows, &ComparisonRow::color)) return "";
  std::string out =
      "<h2>Worst frames</h2><p class='soft'>Click a picture or press the space bar to flip between A and B; the keys "
      "A, "
      "B and D choose. The difference is FLIP (HDR-FLIP above 1): black is the same, bright is noticed.</p>";
  try {
    for (std::size_t i : c.worst) out += picture_box(page_pictures(job, c.frames[i], scratch, workers));
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::output) throw;
    out += "<p>There are no pictures: " + escaped(failure.what()) + "</p>";
  }
  return out;
}

std::string channel_rows(const Comparison& c) {
  std::string rows;
  constexpr MetricId columns[] = {MetricId::differing, MetricId::not_finite, MetricId::max, MetricId::mean,
                                  MetricId::rmse};
  for (const ComparisonRow& row : c.rows) {
    if (row.color) continue;
    rows += "<tr><td>" + escaped(row.name) + "</td>";
    for (MetricId id : columns) rows += "<td class='n'>" + figure_text(id, row.sequence[id]) + "</td>";
    rows += "</tr>";
  }
  if (rows.empty()) return "";
  std::string head;
  for (MetricId id : columns) head += "<th class='n'>" + std::string(metric_of(id).name) + "</th>";
  return "<h2>Other channels</h2><div class='scroll'><table><tr><th>channel</th>" + head + "</tr>" + rows +
         "</table></div>";
}

}  // namespace

std::string comparison_page(const Comparison& c, const CompareJob& job, const std::string& scratch, Workers& workers) {
  std::string out =
      "<!doctype html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
      "content='width=device-width, initial-scale=1'><title>Comparison</title>";
  out += kStyle;
  out += "</head><body><main><h1>Comparison</h1><p class='soft'>A, the reference: <code>" + escaped(job.a.text()) +
         "</code><br>B: <code>" + escaped(job.b.text()) + "</code><br>Frames " + format_frame_list(c.frames) +
         "</p><div class='verdict " + name_of(c.verdict) + "'>" + escaped(verdict_sentence(c)) + "</div>";
  const std::vector<std::string> remarks = remarks_of(c);
  if (!remarks.empty()) out += "<ul>";
  for (const std::string& remark : remarks) out += "<li>" + escaped(remark) + "</li>";
  if (!remarks.empty()) out += "</ul>";
  if (c.verdict != Verdict::incomparable) {
    out += pictures(c, job, scratch, workers);
    for (const ComparisonRow& row : c.rows)
      if (row.color) out += "<h2>Color " + escaped(row.name) + "</h2>" + metric_table(c, job, row) + plots(c, job, row);
    out += channel_rows(c);
  }
  return out + "<p class='soft'>varve " + version() + "</p></main>" + kScript + "</body></html>\n";
}

}  // namespace varve
