// varve measure, and the copy it compares times with.
#include "measure_sequence.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "base/printable.h"
#include "commands.h"
#include "copy_sequence.h"
#include "exr/pictures.h"
#include "exr/write_frame.h"
#include "option.h"
#include "plan/preset.h"
#include "report.h"
#include "signals.h"
#include "stages/measure_text.h"
#include "stages/trade_plot.h"

namespace varve::cli {
namespace {

constexpr int kPlotScale = 2;  // pixels of a PNG for one of the SVG

MeasureJob finished_job(Settings& settings) {
  finish_job(settings);
  MeasureJob job = settings.measure;
  job.resolve = settings.job;
  job.motion = settings.motion_files;
  for (const auto& [commands, word] : settings.given)
    if (commands & kFloor) job.resolve_words.push_back(word);
  job.skip_impossible = settings.presets.empty();  // all presets were asked for, not each of them
  if (settings.presets.empty())
    for (const Preset& preset : presets()) settings.presets.emplace_back(preset.name);
  job.settings = make_settings(settings.presets, settings.sweeps, settings.singles);
  std::error_code failed;
  job.program = std::filesystem::read_symlink("/proc/self/exe", failed).string();
  if (failed) throw Failure(ExitCode::output, "the program cannot find itself in /proc: " + failed.message());
  const char* temporary = std::getenv("TMPDIR");
  if (job.scratch.empty()) job.scratch = temporary && *temporary ? temporary : "/tmp";
  return job;
}

bool ends_with(const std::string& text, std::string_view end) { return std::string_view(text).ends_with(end); }

/// Reports that cannot be written are told before the runs.
void check_reports(const Settings& settings) {
  const std::string& plot = settings.plot_file;
  if (!plot.empty() && !ends_with(plot, ".svg") && !ends_with(plot, ".png"))
    throw Failure(ExitCode::usage, "--plot takes a file name that ends in .svg or .png, not '" + plot + "'");
  for (const std::string& file : {settings.csv_file, settings.json_file, plot})
    if (!file.empty() && file != "-") check_writable(file);
}

void write_plot(const std::string& file, const Measurement& m) {
  const Drawing drawing = trade_plot(m);
  if (ends_with(file, ".svg"))
    write_file(file, drawing_svg(drawing));
  else
    write_color_png(file, drawing_pixels(drawing, kPlotScale), nullptr);
}

MeasureEvents events_of(const Settings& settings) {
  MeasureEvents events;
  events.should_stop = [] { return stop_signal() != 0; };
  if (settings.quiet) return events;
  events.warning = [](const std::string& sentence) {
    std::fputs(("varve: warning: " + printable(sentence) + "\n").c_str(), stderr);
  };
  const bool terminal = isatty(STDERR_FILENO) == 1;
  events.step = [terminal](const std::string& what, int done, int total) {
    if (terminal)
      std::fputs(
          what.empty()
              ? "\r\x1b[K"
              : ("\r\x1b[Krun " + std::to_string(done + 1) + " of " + std::to_string(total) + ": " + what).c_str(),
          stderr);
    else if (!what.empty())
      std::fputs(("run " + std::to_string(done + 1) + " of " + std::to_string(total) + ": " + what + "\n").c_str(),
                 stderr);
  };
  return events;
}

}  // namespace

int run_measure(Settings& settings) {
  const MeasureJob job = finished_job(settings);
  check_reports(settings);
  watch_signals({});
  const Measurement m = measure_sequence(job, events_of(settings));
  if (settings.json_file == "-")
    std::fputs(measure_json(m, job).c_str(), stdout);
  else
    std::fputs(measure_text(m, job).c_str(), stdout);
  if (!settings.json_file.empty() && settings.json_file != "-") write_file(settings.json_file, measure_json(m, job));
  if (!settings.csv_file.empty()) write_file(settings.csv_file, measure_csv(m));
  if (!settings.plot_file.empty()) write_plot(settings.plot_file, m);
  return int(ExitCode::done);
}

int run_floor(Settings& settings) {
  if (settings.job.output.text().empty())
    throw Failure(ExitCode::usage, "floor needs --output: the files to write, such as copy/shot.####.exr");
  finish_job(settings);
  copy_sequence(settings.job);
  return int(ExitCode::done);
}

}  // namespace varve::cli
