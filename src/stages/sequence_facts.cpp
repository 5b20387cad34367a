#include "stages/sequence_facts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/json.h"
#include "diagnose/color_print.h"
#include "stages/find_cut.h"
#include "stages/main_frame.h"

namespace varve {
namespace {

constexpr int kLongestFlash = 2;                                    // frames
constexpr int kBefore = 1 + kLongestFlash, kAfter = kLongestFlash;  // frames that decide beside the one in question
constexpr double kStandsOut = 0.2, kOtherColors = 0.1;              // see stands_out()
const double kStep = std::log2(1.2);                                // stops: less is no step of the exposure
constexpr double kAgreed = 0.85;                                    // share of the picture that takes the same step

/// What two frames have to do with each other.
struct Relation {
  bool known = false;
  CutEvidence cut;
  ExposureStep exposure;

  bool steps() const {
    return exposure.agreed >= kAgreed && std::abs(std::log2(std::max(exposure.ratio, 1e-30))) >= kStep;
  }
  bool breaks() const { return known && (cut.cut || steps()); }
  bool explained() const { return known && cut.judged > 0; }
};

Relation relate(const FrameTrace& before, const FrameTrace& now, int steps) {
  return {true, judge_cut(before, now, steps), exposure_step(before, now, steps)};
}

struct Seen {
  int frame = 0;
  bool asked = false;          // not only there for its neighbors
  std::uint64_t print = 0;     // of the colors; 0: flat, which many frames are
  Relation from[kBefore + 1];  // [n]: from the frame n before
};

std::string text_of(const char* format, double a, double b = 0) {
  char text[320];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

/// The frames to read: those asked for, and those beside them that are there.
std::vector<std::pair<int, bool>> with_neighbors(const ResolveJob& job, const std::vector<int>& frames) {
  const std::set<int> asked(frames.begin(), frames.end());
  std::set<int> all = asked;
  if (job.input.color.has_frame())
    for (const int f : job.input.color.frames_on_disk()) {
      const auto near = asked.lower_bound(f - kAfter);
      if (near != asked.end() && std::int64_t(*near) <= std::int64_t(f) + kBefore) all.insert(f);
    }
  std::vector<std::pair<int, bool>> list;
  for (const int f : all) list.emplace_back(f, asked.contains(f));
  return list;
}

std::vector<Seen> look_at(const ResolveJob& job, const std::vector<int>& frames, const std::function<bool()>& stop,
                          Workers& workers) {
  const JitterSource none = parse_jitter_source("none");
  std::vector<Seen> seen;
  std::deque<FrameTrace> traces;  // the newest last
  MainFrame before;
  for (const auto& [frame, asked] : with_neighbors(job, frames)) {
    if (stop && stop()) break;
    MainFrame now;
    try {
      now = read_main_frame(job.input, frame, job.roles, none, job.parameters.motion, workers);
    } catch (const Failure&) {
      if (asked) throw;
      continue;  // nobody asked for this one
    }
    if (!traces.empty() && traces.back().frame != frame - 1) traces.clear();
    traces.push_back(trace_of(now.present, motion_to_previous(now, traces.empty() ? nullptr : &before),
                              now.world_to_camera, frame, workers));
    if (traces.size() > kBefore + 1) traces.pop_front();
    Seen s{frame, asked, color_print(now.present.color, workers), {}};
    for (std::size_t n = 1; n < traces.size(); ++n)
      s.from[n] = relate(traces[traces.size() - 1 - n], traces.back(), int(n));
    seen.push_back(std::move(s));
    before = std::move(now);
  }
  return seen;
}

/// Frames of a flash that begins at seen[i]; 0: none. What follows it is what was before.
int flash_length(const std::vector<Seen>& seen, std::size_t i) {
  if (!seen[i].from[1].breaks()) return 0;
  for (int n = 1; n <= kLongestFlash && i + std::size_t(n) < seen.size(); ++n) {
    const Seen& after = seen[i + std::size_t(n)];
    const Relation& across = after.from[n + 1];
    if (across.known && !across.breaks() && after.from[1].breaks()) return n;
  }
  return 0;
}

/// A cut stands out: where the vectors explain the pictures beside it hardly better, they are poor vectors.
bool stands_out(const std::vector<Seen>& seen, std::size_t i) {
  double usual = 1;
  bool any = false;
  for (const std::size_t k : {i - 1, i + 1})
    if (k < seen.size() && seen[k].from[1].explained()) {
      usual = std::min(usual, seen[k].from[1].cut.unexplained);
      any = true;
    }
  const CutEvidence& cut = seen[i].from[1].cut;
  return !any || cut.unexplained >= usual + kStandsOut || cut.distance >= kOtherColors;
}

void find_breaks(const std::vector<Seen>& seen, std::vector<SequenceFact>& facts) {
  using enum SequenceFact::Kind;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Relation& r = seen[i].from[1];
    if (!r.breaks() || (r.cut.cut && !stands_out(seen, i))) continue;
    // The end of a flash, which must not be taken for a beginning.
    bool ends = false;
    for (int n = 1; n <= kLongestFlash && std::size_t(n) <= i; ++n)
      ends = ends || flash_length(seen, i - std::size_t(n)) == n;
    if (ends) continue;
    SequenceFact fact;
    fact.frame = fact.until = seen[i].frame;
    fact.ratio = r.exposure.ratio;
    if (const int length = flash_length(seen, i); length > 0) {
      const Relation& across = seen[i + std::size_t(length)].from[length + 1];
      fact.kind = flash;
      fact.until = fact.frame + length - 1;
      fact.evidence = (r.cut.cut ? r.cut.sentence
                                 : text_of("light times %.2f in %.0f %% of the picture", r.exposure.ratio,
                                           100 * r.exposure.agreed)) +
                      "; but frame " + std::to_string(fact.until + 1) + " goes on from frame " +
                      std::to_string(fact.frame - 1) + ": " + across.cut.sentence;
    } else if (r.cut.cut) {
      fact.kind = cut;
      fact.evidence = r.cut.sentence;
    } else {
      fact.kind = exposure;
      fact.evidence =
          text_of("light times %.3f in %.0f %% of the picture at once", r.exposure.ratio, 100 * r.exposure.agreed) +
          "; --gain on of --accumulator gather follows it";
    }
    if (seen[i].asked) facts.push_back(std::move(fact));
  }
}

void find_repeats(const std::vector<Seen>& seen, std::vector<SequenceFact>& facts) {
  using enum SequenceFact::Kind;
  std::map<std::uint64_t, int> latest;
  std::int64_t distance = 0;  // of the last fact
  for (const Seen& s : seen) {
    if (s.print == 0) continue;
    const auto known = latest.find(s.print);
    const int other = known == latest.end() ? s.frame : known->second;
    latest[s.print] = s.frame;
    if (other == s.frame || !s.asked) continue;
    const std::int64_t back = std::int64_t(s.frame) - other;
    if (!facts.empty() && facts.back().until == s.frame - 1 && back == distance) {
      facts.back().until = s.frame;
      facts.back().kind = back == 1 ? freeze : duplicate;
      continue;
    }
    SequenceFact fact;
    fact.kind = duplicate;
    fact.frame = fact.until = s.frame;
    fact.other = other;
    facts.push_back(std::move(fact));
    distance = back;
  }
  for (SequenceFact& fact : facts) {
    const bool several = fact.until > fact.frame && fact.kind == duplicate;
    fact.evidence =
        (several ? "to the last bit, each is the frame " + std::to_string(fact.frame - fact.other) + " before it"
                 : "every pixel is the same to the last bit as in frame " + std::to_string(fact.other)) +
        "; that adds nothing";
  }
}

void find_gaps(const std::vector<Seen>& seen, std::vector<SequenceFact>& facts) {
  // On twos, the odd numbers are no gaps.
  std::int64_t step = 0;
  const auto distance = [&](std::size_t i) { return std::int64_t(seen[i].frame) - seen[i - 1].frame; };
  for (std::size_t i = 1; i < seen.size(); ++i) step = step == 0 ? distance(i) : std::min(step, distance(i));
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (distance(i) == step || !seen[i].asked) continue;
    SequenceFact fact;
    fact.kind = SequenceFact::Kind::gap;
    fact.frame = seen[i - 1].frame + 1;
    fact.until = seen[i].frame - 1;
    fact.evidence = "no file has these numbers; the history starts anew after them";
    facts.push_back(std::move(fact));
  }
}

}  // namespace

const char* name_of(SequenceFact::Kind kind) {
  constexpr const char* kNames[] = {"cut", "flash", "freeze", "duplicate", "exposure", "gap"};
  return kNames[int(kind)];
}

std::map<int, std::string> SequenceFacts::cuts() const {
  std::map<int, std::string> found;
  for (const SequenceFact& fact : facts)
    if (fact.kind == SequenceFact::Kind::cut) found.emplace(fact.frame, fact.evidence);
  return found;
}

SequenceFacts find_facts(const ResolveJob& job, const std::vector<int>& frames, const std::function<bool()>& stop,
                         Workers& workers) {
  const std::vector<Seen> seen = look_at(job, frames, stop, workers);
  SequenceFacts result;
  for (const Seen& s : seen)
    if (s.asked) result.frames.push_back(s.frame);
  find_repeats(seen, result.facts);
  find_breaks(seen, result.facts);
  find_gaps(seen, result.facts);
  std::stable_sort(result.facts.begin(), result.facts.end(),
                   [](const SequenceFact& a, const SequenceFact& b) { return a.frame < b.frame; });
  return result;
}

std::string facts_text(const SequenceFacts& facts) {
  std::string text = "\nFacts from the pixels of " + std::to_string(facts.frames.size()) + " frames\n";
  if (facts.facts.empty()) text += "  no cut, flash, freeze, doubled or missing frame, and no step of the exposure\n";
  for (const SequenceFact& f : facts.facts) {
    text += "  " + std::string(name_of(f.kind)) + " at " + std::to_string(f.frame);
    if (f.until > f.frame) text += "-" + std::to_string(f.until);
    text += ": " + f.evidence + "\n";
  }
  return text;
}

std::string facts_json(const SequenceFacts& facts) {
  std::string text = "{\"frames\":" + std::to_string(facts.frames.size()) + ",\"found\":[";
  for (std::size_t i = 0; i < facts.facts.size(); ++i) {
    const SequenceFact& f = facts.facts[i];
    const bool repeats = f.kind == SequenceFact::Kind::freeze || f.kind == SequenceFact::Kind::duplicate;
    text += std::string(i > 0 ? "," : "") + "{\"kind\":" + json_quote(name_of(f.kind)) +
            ",\"frame\":" + std::to_string(f.frame) + ",\"until\":" + std::to_string(f.until) +
            ",\"repeats\":" + (repeats ? std::to_string(f.other) : "null") + ",\"ratio\":" + json_number(f.ratio) +
            ",\"evidence\":" + json_quote(f.evidence) + "}";
  }
  return text + "]}";
}

}  // namespace varve
