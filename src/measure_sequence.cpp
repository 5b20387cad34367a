#include "measure_sequence.h"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/process.h"
#include "compare_sequence.h"
#include "diagnose/trade.h"
#include "stages/preflight.h"
#include "stages/read_pair.h"
#include "stages/score_left_out.h"

namespace varve {
namespace {

/// A folder of its own that goes with the object, and everything in it.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& above) : path_(above + "/varve-measure-XXXXXX") {
    if (!mkdtemp(path_.data()))
      throw Failure(ExitCode::output, "no folder can be made in '" + above + "' (" + std::strerror(errno) +
                                          "); choose another with --scratch");
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }
  SequencePattern frames() const { return SequencePattern::parse(path_ + "/run/out.####.exr"); }
  /// An empty folder for the next run.
  void clear() const {
    std::filesystem::remove_all(path_ + "/run");
    std::filesystem::create_directory(path_ + "/run");
  }

 private:
  std::string path_;
};

/// Times of one thing over its repeats.
struct Runs {
  std::vector<double> wall, cpu, peak;
  void add(const ProcessRun& run) {
    wall.push_back(run.wall_seconds);
    cpu.push_back(run.cpu_seconds);
    peak.push_back(run.peak_mib);
  }
};

ProcessRun run_varve(const MeasureJob& job, const ScratchFolder& scratch, const std::string& command,
                     const std::vector<std::string>& more, const std::string& name) {
  scratch.clear();
  std::vector<std::string> words = {command, job.resolve.input.color.text(), "--output", scratch.frames().text()};
  words.insert(words.end(), job.resolve_words.begin(), job.resolve_words.end());
  words.insert(words.end(), more.begin(), more.end());
  ProcessRun run = run_process(job.program, words, scratch.path() + "/messages");
  if (run.code == 0) return run;
  std::string why = run.messages.substr(0, run.messages.find('\n'));
  const std::string prefix = "varve: error: ";
  if (why.starts_with(prefix)) why.erase(0, prefix.size());
  const bool known = run.code >= int(ExitCode::usage) && run.code <= int(ExitCode::self_check);
  throw Failure(known             ? ExitCode(run.code)
                : run.code >= 128 ? ExitCode::interrupted
                                  : ExitCode::self_check,
                "the run of '" + name + "' ended with code " + std::to_string(run.code) + ": " + why);
}

CompareJob compare_job(const MeasureJob& job, const SequencePattern& output, const std::vector<int>& frames) {
  CompareJob compare;
  compare.a = *job.reference;
  compare.b = output;
  compare.frames = frames;
  compare.cuts = job.resolve.cuts;
  compare.threads = job.resolve.threads;
  // What is made of several layers stands in the place of the main color.
  if (job.resolve.roles.combine_layers.mode == LayersMode::apart) compare.roles_b.layers = job.resolve.roles.layers;
  compare.roles_b.map = job.resolve.roles.map;
  compare.metrics.reset();
  for (MetricId id : {MetricId::psnr_tone, MetricId::flip, MetricId::flicker, MetricId::ghost, MetricId::sharpness,
                      MetricId::not_finite})
    compare.metrics.set(std::size_t(id));
  return compare;
}

/// Which frames the reference has, told before an hour of runs and not after.
void find_reference(const MeasureJob& job, Measurement& m) {
  const std::vector<int> there = job.reference->frames_on_disk();
  const std::string what = "the reference '" + job.reference->text() + "'";
  if (there.empty()) throw Failure(ExitCode::input, "no file of " + what + " is there; check the pattern");
  std::ranges::set_intersection(m.frames, there, std::back_inserter(m.scored));
  if (m.scored.empty())
    throw Failure(ExitCode::inconsistent, what + " has frames " + format_frame_list(there) + " and the input has " +
                                              format_frame_list(m.frames) + ": none in common");
  if (m.scored.size() < m.frames.size())
    m.notes.push_back("the reference has " + std::to_string(m.scored.size()) + " of the " +
                      std::to_string(m.frames.size()) + " frames: those are scored (" + format_frame_list(m.scored) +
                      ")");
  const FramePair pair = read_frame_pair(compare_job(job, job.resolve.input.color, m.scored), m.scored.front(), false);
  if (!pair.match.incomparable.empty())
    throw Failure(ExitCode::inconsistent, "the input cannot be compared with " + what + ": frame " +
                                              std::to_string(m.scored.front()) + ": " + pair.match.incomparable);
}

void score_with_reference(const MeasureJob& job, const ScratchFolder& scratch, const Measurement& m,
                          SettingFigures& figures) {
  const Comparison c = compare_sequence(compare_job(job, scratch.frames(), m.scored), {});
  if (!c.reason.empty()) throw Failure(ExitCode::inconsistent, c.reason);
  const auto color = std::ranges::find(c.rows, true, &ComparisonRow::color);
  if (color == c.rows.end()) throw Failure(ExitCode::inconsistent, "input and reference have no color in common");
  const MetricValues& values = color->sequence;
  figures.psnr_tone = values[MetricId::psnr_tone];
  figures.flip = values[MetricId::flip];
  figures.flicker = values[MetricId::flicker];
  figures.ghost = values[MetricId::ghost];
  figures.sharpness = values[MetricId::sharpness];
  figures.not_finite = values[MetricId::not_finite];
  figures.error = std::pow(10, -0.1 * figures.psnr_tone);
}

void score_without_reference(const MeasureJob& job, const ScratchFolder& scratch, const Measurement& m,
                             SettingFigures& figures) {
  Workers workers(job.resolve.threads);
  const LeftOutScore score = score_left_out(job, scratch.frames(), m.frames, workers);
  figures.leave_out = score.leave_out.decibels();
  figures.unsteady = score.unsteady.mean();
  if (m.with_reference) return;
  figures.not_finite = double(score.not_finite);
  figures.error = score.leave_out.mean();
}

std::size_t find_baseline(const MeasureJob& job) {
  const auto index = [&](const std::string& name) {
    return std::size_t(std::ranges::find(job.settings, name, &Setting::name) - job.settings.begin());
  };
  if (job.baseline.empty()) {
    const std::size_t standard = index("standard");
    return standard < job.settings.size() ? standard : 0;
  }
  const std::size_t found = index(job.baseline);
  if (found == job.settings.size()) {
    std::string names;
    for (const Setting& s : job.settings) names += (names.empty() ? "'" : ", '") + s.name() + "'";
    throw Failure(ExitCode::usage, "there is no setting '" + job.baseline + "' to be the baseline; there are " + names);
  }
  return found;
}

std::size_t count_pixels(const MeasureJob& job, const Measurement& m) {
  const JitterSource jitter = parse_jitter_source(job.resolve.jitter);
  std::size_t pixels = 0;
  for (int frame : m.frames) {
    const FrameHeaders headers = read_frame_headers(job.resolve.input, frame, job.resolve.roles, jitter);
    for (const Subject& s : headers.subjects)
      pixels += headers.files.front().parts[std::size_t(part_of(s))].data_window.pixels();
  }
  return pixels;
}

void put_times(Measurement& m, const std::vector<Runs>& runs, const Runs& floor, std::size_t pixels) {
  const double frames = double(m.frames.size());
  m.floor_seconds = median(floor.wall) / frames;
  m.floor_mib = median(floor.peak);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    SettingFigures& f = m.settings[i];
    f.seconds = median(runs[i].wall) / frames;
    f.cpu_seconds = median(runs[i].cpu) / frames;
    f.pixels_per_second = double(pixels) / median(runs[i].wall);
    f.peak_mib = median(runs[i].peak);
  }
  for (SettingFigures& f : m.settings) {
    f.to_baseline = f.seconds / m.settings[m.baseline].seconds;
    f.to_floor = f.seconds / m.floor_seconds;
  }
}

void conclude(const MeasureJob& job, Measurement& m) {
  std::vector<TradePoint> points;
  std::vector<double> truth, left_out;
  for (const SettingFigures& f : m.settings) {
    points.push_back({f.seconds, f.error});
    truth.push_back(f.psnr_tone);
    left_out.push_back(f.leave_out);
  }
  const std::vector<bool> front = pareto_front(points);
  for (std::size_t i = 0; i < front.size(); ++i) m.settings[i].on_front = front[i];
  m.recommended = cheapest_within(points, job.within);
  m.rank_correlation = rank_correlation(truth, left_out);
}

/// The settings that the sequence has everything for.
std::vector<Setting> possible_settings(const MeasureJob& job, const SequenceInfo& info, const MeasureEvents& events) {
  std::vector<Setting> possible;
  for (const Setting& setting : job.settings) try {
      make_plan(info, setting.parameters, {}, job.resolve.threads);
      possible.push_back(setting);
    } catch (const Failure& failure) {
      if (events.warning) events.warning(setting.name() + " is left out: " + failure.what());
    }
  return possible;
}

}  // namespace

Measurement measure_sequence(const MeasureJob& asked, const MeasureEvents& events) {
  // What will be run, and against what: headers only.
  Measurement m;
  MeasureJob job = asked;
  const SequenceInfo info =
      probe_sequence(job.resolve.input, job.resolve.frames, job.resolve.roles, parse_jitter_source(job.resolve.jitter));
  check_roles(job.resolve, info);
  if (job.skip_impossible) job.settings = possible_settings(asked, info, events);
  m.baseline = find_baseline(job);
  m.frames = info.frames;
  m.with_reference = job.reference.has_value();
  if (m.with_reference)
    find_reference(job, m);
  else
    m.scored = m.frames;
  const std::size_t pixels = count_pixels(job, m);
  for (const Setting& setting : job.settings) m.settings.push_back({setting.name()});

  const bool left_out = !m.with_reference || job.leave_out;
  const int total = job.repeats * int(job.settings.size());
  int done = 0;
  const auto step = [&](const std::string& what) {
    if (events.should_stop && events.should_stop()) throw Failure(ExitCode::interrupted, "the measurement was stopped");
    if (events.step) events.step(what, done, total);
  };

  // Interleaved, so that a machine that slows down slows all of them. The first copy only fills the page cache.
  const ScratchFolder scratch(job.scratch);
  Runs floor;
  std::vector<Runs> runs(job.settings.size());
  run_varve(job, scratch, "floor", {}, "floor");
  for (int repeat = 0; repeat < job.repeats; ++repeat) {
    floor.add(run_varve(job, scratch, "floor", {}, "floor"));
    for (std::size_t i = 0; i < job.settings.size(); ++i, ++done) {
      step(m.settings[i].name);
      std::vector<std::string> words = job.settings[i].arguments();
      words.emplace_back("--quiet");
      runs[i].add(run_varve(job, scratch, "resolve", words, m.settings[i].name));
      if (m.with_reference && repeat == 0) score_with_reference(job, scratch, m, m.settings[i]);
      if (left_out && repeat == 0) score_without_reference(job, scratch, m, m.settings[i]);
    }
  }

  put_times(m, runs, floor, pixels);
  conclude(job, m);
  if (events.step) events.step("", total, total);
  return m;
}

}  // namespace varve
