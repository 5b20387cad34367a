#include "stages/check_jitter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/json.h"
#include "diagnose/resting_offsets.h"
#include "diagnose/stuck_detail.h"
#include "stages/main_frame.h"

namespace varve {
namespace {

constexpr std::size_t kWindow = 16;   // frames that are held at a time
constexpr std::size_t kApart = 3;     // frames between the two of a pair, at most
constexpr double kTells = 0.1;        // px: a shift with a larger standard error says nothing
constexpr double kConsistent = 0.05;  // px rms: shifts that contradict each other by more are none
constexpr double kWidest = 0.75;      // px: an offset further from the mean does not lie in the pixel
constexpr double kIdentical = 0.999, kStuck = 0.3, kTextured = 1e-4, kFewMove = 1000;
// Moving shadows and reflected light leave fewer pixels the same: 0.84 of scripts/check_blender; jittered or noisy
// frames have 0.22 at most where so much has structure.
constexpr double kMostlyIdentical = 0.6, kMuchTextured = 0.05;
constexpr double kRests = 0.02;      // share of the picture that rests and has structure
constexpr float kStill = 1.0f / 64;  // px
constexpr double kOffCenter = 0.15;  // px

/// The longest run of numbers that follow each other; the first of several.
std::vector<int> longest_run(const std::vector<int>& frames) {
  std::size_t best = 0, length = 0;
  for (std::size_t begin = 0; begin < frames.size();) {
    std::size_t end = begin + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    if (end - begin > length) best = begin, length = end - begin;
    begin = end;
  }
  return {frames.begin() + std::ptrdiff_t(best), frames.begin() + std::ptrdiff_t(best + length)};
}

/// What is kept of a frame while others are held against it.
struct Held {
  Plane<float> tone;
  Plane<glm::vec2> motion;  // to the frame before; empty: at rest
};

/// The way from a frame over `first` to the one that `second` leads to, read at the nearest pixel.
Plane<glm::vec2> chain(const Plane<glm::vec2>& first, const Plane<glm::vec2>& second, Workers& workers) {
  if (second.empty()) return first.empty() ? Plane<glm::vec2>() : first.clone();
  if (first.empty()) return second.clone();
  const Window& w = first.window();
  Plane<glm::vec2> sum(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::vec2 m = first.at(x, y);
      const double ux = std::floor(x + double(m.x) + 0.5), uy = std::floor(y + double(m.y) + 0.5);
      const Window& v = second.window();
      sum.at(x, y) = ux >= v.x0 && uy >= v.y0 && ux < v.x1 && uy < v.y1
                         ? m + second.at(int(ux), int(uy))
                         : glm::vec2(std::numeric_limits<float>::quiet_NaN());
    }
  });
  return sum;
}

/// Holds the newest frame against those before it.
void compare_newest(const std::deque<Held>& held, std::size_t newest, JitterCheck& check, Workers& workers) {
  const Held& now = held.back();
  Plane<glm::vec2> way;
  for (std::size_t apart = 1; apart < std::min(held.size(), kApart + 1); ++apart) {
    const Held &between = held[held.size() - apart], &before = held[held.size() - 1 - apart];
    way = apart == 1 ? (between.motion.empty() ? Plane<glm::vec2>() : between.motion.clone())
                     : chain(way, between.motion, workers);
    const SubPixelShift s = measure_shift(now.tone, before.tone, way, workers);
    ++check.tried;
    if (s.found && s.sigma.x < kTells && s.sigma.y < kTells)
      check.shifts.push_back({newest, newest - apart, s.shift, s.sigma});
    if (apart > 1) continue;
    const StuckDetail stuck = stuck_detail(now.tone, before.tone, way, workers);
    check.neighbors.push_back({check.frames[newest], s, stuck.correlation, stuck.pixels});
  }
}

/// Pixels that rest in all of these frames, with their neighbors.
Plane<std::uint8_t> resting_pixels(const std::deque<Held>& held, std::size_t begin, std::size_t end, Workers& workers) {
  Window w = held[begin].tone.window();
  for (std::size_t i = begin; i < end; ++i) w = intersect(w, held[i].tone.window());
  Plane<std::uint8_t> resting(w, 0, std::uint8_t(1));
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x)
      for (std::size_t i = begin + 1; i < end; ++i) {
        if (held[i].motion.empty()) continue;
        for (int v = std::max(w.y0, y - 1); v < std::min(w.y1, y + 2); ++v)
          for (int u = std::max(w.x0, x - 1); u < std::min(w.x1, x + 2); ++u) {
            const glm::vec2 m = held[i].motion.at(u, v);
            if (!(std::abs(m.x) < kStill && std::abs(m.y) < kStill)) resting.at(x, y) = 0;
          }
      }
  });
  return resting;
}

/// Offsets of frames that rest, held[begin] to held[end]; `first` is the place of held[0] in the list of frames.
void measure_at_rest(const std::deque<Held>& held, std::size_t begin, std::size_t end, std::size_t first,
                     JitterCheck& check, std::vector<ShiftBetween>& found, Workers& workers) {
  if (end - begin < kFewestAtRest) return;
  std::vector<const Plane<float>*> tones;
  for (std::size_t i = begin; i < end; ++i) tones.push_back(&held[i].tone);
  std::vector<ShiftBetween> guesses;
  for (ShiftBetween s : check.shifts) {
    if (s.before < first + begin || s.now >= first + end) continue;
    s.now -= first + begin, s.before -= first + begin;
    guesses.push_back(s);
  }
  const OffsetFit start = fit_offsets(end - begin, guesses);
  const RestingOffsets rest = resting_offsets(tones, resting_pixels(held, begin, end, workers), start.offsets, workers);
  if (!rest.found) return;
  for (std::size_t i = 1; i < rest.offsets.size(); ++i)
    for (std::size_t apart = 1; apart <= std::min(i, kApart); ++apart) {
      const glm::dvec2 a = rest.sigma[i], b = rest.sigma[i - apart];
      const glm::dvec2 sigma(std::hypot(a.x, b.x), std::hypot(a.y, b.y));
      if (sigma.x < kTells && sigma.y < kTells)
        found.push_back(
            {first + begin + i, first + begin + i - apart, rest.offsets[i] - rest.offsets[i - apart], sigma});
    }
}

/// All runs of frames at rest among those that are held.
void measure_runs_at_rest(const std::deque<Held>& held, std::size_t first, JitterCheck& check,
                          std::vector<ShiftBetween>& found, Workers& workers) {
  for (std::size_t begin = 0; begin < held.size();) {
    std::size_t end = begin + 1;
    // The neighbor shifts begin with the second frame of all. Where the camera starts, little goes on resting.
    double most = 0;
    for (; end < held.size(); ++end) {
      const double rests = check.neighbors[first + end - 1].measured.textured;
      if (!(rests > std::max(kRests, most / 2))) break;
      most = std::max(most, rests);
    }
    measure_at_rest(held, begin, end, first, check, found, workers);
    begin = end;
  }
}

/// What was measured at rest is surer than a single pair.
void prefer(std::vector<ShiftBetween> found, std::vector<ShiftBetween>& shifts) {
  std::erase_if(shifts, [&](const ShiftBetween& s) {
    return std::any_of(found.begin(), found.end(),
                       [&](const ShiftBetween& f) { return f.now == s.now && f.before == s.before; });
  });
  shifts.insert(shifts.end(), found.begin(), found.end());
}

std::string text_of(const char* format, double a, double b = 0, double c = 0) {
  char text[320];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

template <class Value>
double median_of(const std::vector<NeighborShift>& neighbors, Value value) {
  std::vector<double> values;
  for (const NeighborShift& n : neighbors) values.push_back(value(n));
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double widest_offset(const OffsetFit& fit) {
  double widest = 0;
  for (const glm::dvec2& o : fit.offsets)
    if (std::isfinite(o.x)) widest = std::max({widest, std::abs(o.x), std::abs(o.y)});
  return widest;
}

/// Why the offsets are not known; empty where they are.
std::string find_reason(const JitterCheck& c) {
  if (c.frames.size() < 2) return "there is one frame only, and offsets are seen by the difference of two";
  if (median_of(c.neighbors, [](const NeighborShift& n) { return double(n.measured.pixels); }) < 500)
    return "hardly a pixel can be followed from frame to frame";
  if (c.shifts.size() * 2 < c.tried || c.fit.known < c.frames.size())
    return text_of(
               "only %.0f of %.0f pairs of frames show the shift between them to 0.1 px: there is too little "
               "texture, too much noise, or the picture moves otherwise than its vectors say",
               double(c.shifts.size()), double(c.tried)) +
           (c.vectors ? "" : " (there are no vectors)");
  if (!(c.fit.misfit <= kConsistent))
    return text_of(
               "the shifts between frames contradict each other by %.2f px: the picture moves otherwise than its "
               "vectors say",
               c.fit.misfit) +
           (c.vectors ? "" : " (there are no vectors)");
  if (widest_offset(c.fit) > kWidest)
    return text_of(
               "the pictures drift by %.2f px from their mean, more than a jitter within the pixel: something "
               "moves that the vectors do not tell",
               widest_offset(c.fit)) +
           (c.vectors ? "" : " (there are no vectors)");
  return "";
}

std::string judge(const JitterCheck& c) {
  const JitterVerdict& v = c.verdict;
  const bool any_stated = std::any_of(c.stated.begin(), c.stated.end(), [](const auto& j) { return j.has_value(); });
  double size = 0;
  for (const glm::dvec2& o : c.fit.offsets) size += (o.x * o.x + o.y * o.y) / (2 * double(c.fit.offsets.size()));
  const bool at_rest = c.measurable && std::sqrt(size) < 0.03;
  if (!c.measurable) return "the pixels do not tell the jitter: " + c.why_not;
  if (at_rest && (!any_stated || v.kind == JitterVerdict::Kind::at_rest))
    return std::string(any_stated ? "a jitter is stated, but " : "") +
           "every frame is sampled at the same place of the pixel (Cycles does so at one sample per pixel, whatever "
           "its pixel filter): many frames show no more detail than one; " +
           (any_stated ? "check that the offsets reach the renderer, or give --jitter none"
                       : "render with a jitter, see varve jitter");
  if (!any_stated)
    return "no jitter is stated, but the frames are jittered; give --jitter pixels, or the file or pattern that the "
           "renderer used";
  switch (v.kind) {
    case JitterVerdict::Kind::fits:
      return text_of("the stated jitter is what the pixels show, to %.3f px rms (next best explanation: %.2f px)",
                     v.misfit, v.runner_up);
    case JitterVerdict::Kind::mistaken:
      return "the stated jitter is not what the pixels show: " + v.mistake.sentence +
             text_of(
                 ". That explains them to %.3f px rms, the offsets as stated to %.2f px, the next best explanation "
                 "to %.2f px. Correct the offsets, or give --jitter pixels",
                 v.misfit, v.as_stated, v.runner_up);
    case JitterVerdict::Kind::unexplained:
      return text_of(
          "the stated jitter is not what the pixels show (%.2f px rms), and no usual mistake explains it "
          "clearly (the best to %.2f px); is it the list of another render? Give --jitter pixels",
          v.as_stated, v.misfit);
    default:
      return "whether the stated jitter is right cannot be told: too few frames can be compared, or not surely enough; "
             "the pixels show the offsets below";
  }
}

std::vector<std::string> find_notes(const JitterCheck& c) {
  std::vector<std::string> notes;
  const auto of = [&](auto value) { return median_of(c.neighbors, value); };
  const double identical = of([](const NeighborShift& n) { return n.measured.identical; });
  const double textured = of([](const NeighborShift& n) { return n.measured.textured; });
  if ((identical > kIdentical && textured > kTextured) || (identical > kMostlyIdentical && textured > kMuchTextured))
    notes.push_back(
        text_of("where nothing moves, %.1f %% of the pixels on structure are the same to the last bit from frame to "
                "frame: ",
                100 * identical) +
        "neither the sample position nor the seed of the noise changes (Blender's default), so there is nothing to "
        "average; animate the seed and jitter the camera");
  const double stuck = of([](const NeighborShift& n) { return n.stuck; });
  const double moving = of([](const NeighborShift& n) { return double(n.stuck_pixels); });
  if (stuck > kStuck && moving > kFewMove)
    notes.push_back(
        text_of("the finest detail stands still on the screen while the picture moves (correlation %.2f in "
                "%.0f pixels): the seed of the noise is the same in every frame, and noise that stands "
                "still is taken for detail; animate the seed",
                stuck, moving));
  glm::dvec2 mean(0);
  double known = 0, widest = 0;
  for (const auto& j : c.stated)
    if (j) mean += *j, ++known, widest = std::max({widest, std::abs(j->x), std::abs(j->y)});
  if (known >= 4) mean /= known;
  if (known >= 4 && (std::abs(mean.x) > kOffCenter || std::abs(mean.y) > kOffCenter))
    notes.push_back(text_of("the stated offsets have a mean of %.3f, %.3f px", mean.x, mean.y) +
                    (widest > 0.51 ? text_of(" and reach %.2f px, out of the pixel", widest) : "") +
                    ": the resolved picture is shifted by that much the other way; pixels show differences of offsets "
                    "only, so if the renderer's own are centered, subtract the mean");
  return notes;
}

}  // namespace

JitterCheck check_jitter(const ResolveJob& job, const std::vector<int>& frames, const JitterSource& stated,
                         Workers& workers) {
  JitterCheck check;
  check.frames = longest_run(frames);
  std::deque<Held> held;
  MainFrame before;
  std::vector<ShiftBetween> at_rest;
  double middle = 0;
  for (std::size_t i = 0; i < check.frames.size(); ++i) {
    MainFrame now = read_main_frame(job.input, check.frames[i], job.roles, stated, job.parameters.motion, workers);
    check.stated.push_back(now.jitter);
    if (!(middle > 0)) middle = middle_luma(now.present.color, now.present.valid);
    held.push_back({tone_plane(now.present.color, now.present.valid, middle, workers),
                    motion_to_previous(now, i > 0 ? &before : nullptr)});
    check.vectors = check.vectors || !held.back().motion.empty();
    compare_newest(held, i, check, workers);
    if (held.size() == kWindow || i + 1 == check.frames.size()) {
      measure_runs_at_rest(held, i + 1 - held.size(), check, at_rest, workers);
      held.erase(held.begin(), held.begin() + std::ptrdiff_t(held.size() / 2));
    }
    before = std::move(now);
  }
  prefer(std::move(at_rest), check.shifts);
  check.fit = fit_offsets(check.frames.size(), check.shifts);
  check.verdict = judge_jitter(check.stated, check.shifts);
  check.why_not = find_reason(check);
  check.measurable = check.why_not.empty();
  check.sentence = judge(check);
  check.notes = find_notes(check);
  return check;
}

JitterSource measured_jitter(const ResolveJob& job, Workers& workers) {
  JitterSource none = parse_jitter_source("none");
  // Always all frames on disk: offsets are known up to their mean, which must not depend on the chunk.
  const SequenceInfo info = probe_sequence(job.input, {}, job.roles, none);
  const JitterCheck check = check_jitter(job, info.frames, none, workers);
  const auto refuse = [](const std::string& why) {
    throw Failure(ExitCode::inconsistent,
                  "--jitter pixels: " + why + "; give the jitter as a CSV file or a pattern, or --jitter none");
  };
  if (!check.measurable) refuse(check.why_not);
  if (check.frames.size() < info.frames.size())
    refuse("the frame numbers have gaps, and only the " + std::to_string(check.frames.size()) + " frames from " +
           std::to_string(check.frames.front()) + " on follow each other");
  JitterSource source;
  source.kind = JitterSource::Kind::table;
  for (std::size_t i = 0; i < check.frames.size(); ++i)
    source.table.emplace(check.frames[i], Jitter{check.fit.offsets[i].x, check.fit.offsets[i].y});
  source.description = text_of("measured in the pixels (they agree to %.3f px; of mean 0)", check.fit.misfit);
  return source;
}

std::string jitter_check_text(const JitterCheck& c) {
  std::string text = "\nJitter in the pixels\n  " + c.sentence + "\n";
  for (const std::string& note : c.notes) text += "  " + note + "\n";
  text += text_of("  %.0f of %.0f pairs of frames used, they agree to %.3f px; ", double(c.shifts.size()),
                  double(c.tried), c.fit.misfit);
  text += std::string(c.vectors ? "along the vectors" : "no vectors: taken to be at rest") + "; offsets of mean 0\n";
  text += "  frame      measured x, y       stated x, y\n";
  for (std::size_t i = 0; i < c.frames.size(); ++i) {
    char row[120];
    std::snprintf(row, sizeof row, "  %5d    %+8.3f %+8.3f", c.frames[i], c.fit.offsets[i].x, c.fit.offsets[i].y);
    text += row;
    if (c.stated[i]) {
      std::snprintf(row, sizeof row, "  %+8.3f %+8.3f", c.stated[i]->x, c.stated[i]->y);
      text += row;
    } else {
      text += "  none";
    }
    text += "\n";
  }
  return text;
}

std::string jitter_check_json(const JitterCheck& c) {
  constexpr const char* kKinds[] = {"fits", "mistaken", "at rest", "unexplained", "cannot tell"};
  const auto pair = [](const glm::dvec2& v) {
    return std::isfinite(v.x) ? "[" + json_number(v.x) + "," + json_number(v.y) + "]" : std::string("null");
  };
  std::string text = std::string("{\"measurable\":") + (c.measurable ? "true" : "false") +
                     ",\"verdict\":" + json_quote(kKinds[int(c.verdict.kind)]) +
                     ",\"mistake\":" + json_quote(c.verdict.mistake.sentence) +
                     ",\"sentence\":" + json_quote(c.sentence) + ",\"misfit\":" + json_number(c.fit.misfit) +
                     ",\"pairs\":" + std::to_string(c.shifts.size()) + ",\"tried\":" + std::to_string(c.tried) +
                     ",\"notes\":[";
  for (std::size_t i = 0; i < c.notes.size(); ++i) text += (i > 0 ? "," : "") + json_quote(c.notes[i]);
  text += "],\"frames\":[";
  for (std::size_t i = 0; i < c.frames.size(); ++i)
    text += std::string(i > 0 ? "," : "") + "{\"frame\":" + std::to_string(c.frames[i]) +
            ",\"measured\":" + pair(c.fit.offsets[i]) + ",\"stated\":" + (c.stated[i] ? pair(*c.stated[i]) : "null") +
            "}";
  return text + "]}";
}

}  // namespace varve
