#include "progress.h"

#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/printable.h"
#include "json.h"
#include "report_fields.h"

namespace varve::cli {
namespace {

/// One call, so that the lines of several programs in one log do not mix.
void put(const std::string& text) { std::fputs(text.c_str(), stderr); }

std::string seconds_text(double seconds) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f s", std::clamp(seconds, 0.0, 1e9));
  return buffer;
}

int percent(int done, int total) { return total > 0 ? int(100.0 * done / total) : 100; }

int terminal_columns() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string count_text(std::size_t count, const char* what) { return ", " + std::to_string(count) + " " + what; }

std::string share_text(std::size_t part, std::size_t whole, const char* what) {
  char text[120];
  std::snprintf(text, sizeof text, ", %.1f %% %s", 100.0 * double(part) / double(std::max<std::size_t>(whole, 1)),
                what);
  return text;
}

// Lights of which a part only was named say nothing by their sum.
bool add_up(const LightSum& lights) { return lights.pixels > 0 && lights.adding_up == lights.pixels; }

std::string residual_text(const LightSum& lights) {
  char text[120];
  std::snprintf(text, sizeof text, ", lights add up to the color within %.2g (%.2g before)", lights.resolved,
                lights.input);
  return text;
}

/// Share of the vectors that were tested and found wrong; empty where none was.
std::string repaired_text(const FrameReport& report) {
  const std::size_t wrong = report.vectors.pixels - report.vectors_by[std::size_t(RepairedBy::kept)];
  if (report.vectors.pixels == 0 || wrong == 0) return "";
  char text[80];
  std::snprintf(text, sizeof text, ", %.2g %% of the vectors wrong",
                100.0 * double(wrong) / double(report.vectors.pixels));
  return text;
}

}  // namespace

std::string clock_text(double seconds) {
  const long whole = std::lround(std::clamp(seconds, 0.0, 1e9));
  char buffer[48];
  if (whole < 3600)
    std::snprintf(buffer, sizeof buffer, "%ld:%02ld", whole / 60, whole % 60);
  else
    std::snprintf(buffer, sizeof buffer, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return buffer;
}

std::string frame_line(const FrameReport& report, int done, int total) {
  std::string line = "frame " + std::to_string(report.frame) + ": ";
  if (report.skipped) {
    line += "complete already, skipped";
  } else {
    line += seconds_text(report.read_seconds) + " read, " + seconds_text(report.resolve_seconds) + " resolve, " +
            seconds_text(report.write_seconds) + " write";
    if (!report.written) line += ", for the history only";
    if (!report.restart.empty()) line += ", restart (" + report.restart + ")";
    if (report.not_finite > 0) line += count_text(report.not_finite, "pixels repaired that were not finite");
    if (report.companions_not_finite > 0)
      line += count_text(report.companions_not_finite, "values of --channels repaired that were not finite");
    if (report.deep_samples > 0) line += count_text(report.deep_samples, "deep samples flattened");
    if (report.deep_repaired > 0)
      line +=
          count_text(report.deep_repaired, "deep samples put right or left out: no depth, ZBack before Z, bad alpha");
    if (add_up(report.lights)) line += residual_text(report.lights);
    if (report.vectors_bad > 0) line += count_text(report.vectors_bad, "unusable vectors");
    if (report.by_camera > 0) line += share_text(report.by_camera, report.with_vectors, "of the vectors by the camera");
    if (report.lens_added > 0)
      line += share_text(report.lens_added, report.with_vectors, "of the vectors with zoom added");
    if (report.opacity_held > 0) line += count_text(report.opacity_held, "layer opacities held within 0 and 1");
    line += repaired_text(report);
    if (report.half_overflows > 0) line += count_text(report.half_overflows, "values beyond half held at 65504");
  }
  return line + ", PROGRESS: " + std::to_string(percent(done, total)) + "%";
}

Progress::Progress(ProgressStyle style, bool quiet)
    : style_(style), quiet_(quiet), start_(std::chrono::steady_clock::now()) {
  if (style_ == ProgressStyle::automatic) style_ = isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::plain;
  if (quiet_) style_ = ProgressStyle::none;
}

double Progress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::frame(const FrameReport& report, int done, int total) {
  switch (style_) {
    case ProgressStyle::bar:
      draw(report, done, total);
      break;
    case ProgressStyle::plain:
      put(frame_line(report, done, total) + "\n");
      break;
    case ProgressStyle::openjd:
      put("openjd_status: " + frame_line(report, done, total) +
          "\nopenjd_progress: " + std::to_string(percent(done, total)) + "\n");
      break;
    case ProgressStyle::json: {
      JsonLine line;
      line.text("event", "frame");
      for (const ReportField<FrameReport>& field : frame_fields()) line.json(field.name, field.value(report));
      put(line.number("done", done).number("total", total).end() + "\n");
      break;
    }
    case ProgressStyle::automatic:
    case ProgressStyle::none:
      break;
  }
}

void Progress::draw(const FrameReport& report, int done, int total) {
  const double elapsed = seconds();
  const double left = done > 0 ? elapsed / done * std::max(total - done, 0) : 0;
  std::string tail = " " + std::to_string(done) + "/" + std::to_string(total) + "  frame " +
                     std::to_string(report.frame) + "  " + seconds_text(done > 0 ? elapsed / done : 0) + "/frame  " +
                     clock_text(left) + " left";
  const int columns = terminal_columns() - 1;  // the last column would wrap
  const int width = std::clamp(columns - int(tail.size()) - 2, 0, 40);
  const int full = total > 0 ? int(double(width) * std::min(done, total) / total) : 0;
  std::string line =
      width > 3 ? "[" + std::string(std::size_t(full), '#') + std::string(std::size_t(width - full), '.') + "]" : "";
  line += tail;
  line.resize(std::min(line.size(), std::size_t(std::max(columns, 1))));
  put("\r" + line + "\x1b[K");
  on_bar_ = true;
}

void Progress::warning(const std::string& sentence) {
  if (quiet_) return;
  if (on_bar_) put("\r\x1b[K");
  on_bar_ = false;
  if (style_ == ProgressStyle::json)
    put(JsonLine().text("event", "warning").text("sentence", sentence).end() + "\n");
  else
    put("varve: warning: " + printable(sentence) + "\n");
}

void Progress::waiting(const std::string& sentence) {
  leave_line();
  if (style_ == ProgressStyle::none) return;
  if (style_ == ProgressStyle::json)
    put(JsonLine().text("event", "waiting").text("sentence", sentence).end() + "\n");
  else
    put((style_ == ProgressStyle::openjd ? "openjd_status: " : "varve: ") + printable(sentence) + "\n");
}

void Progress::leave_line() {
  if (on_bar_) put("\n");
  on_bar_ = false;
}

void Progress::summary(const ResolveSummary& summary) {
  leave_line();
  if (style_ == ProgressStyle::none) return;
  if (style_ == ProgressStyle::json) {
    put(JsonLine()
            .text("event", "summary")
            .number("frames_written", summary.frames_written)
            .number("frames_skipped", summary.frames_skipped)
            .flag("stopped", summary.stopped)
            .number("seconds", seconds())
            .end() +
        "\n");
    return;
  }
  std::string line = "varve: " + std::to_string(summary.frames_written) +
                     (summary.frames_written == 1 ? " frame" : " frames") + " written";
  if (summary.frames_skipped > 0) line += ", " + std::to_string(summary.frames_skipped) + " complete already";
  line += " in " + clock_text(seconds());
  if (summary.stopped) line += ", stopped as asked; --resume goes on from here";
  put((style_ == ProgressStyle::openjd ? "openjd_status: " : "") + line + "\n");
}

}  // namespace varve::cli
