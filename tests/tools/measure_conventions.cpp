// Writes what `probe --motion` finds when a sequence with right vectors had them stored in every other way: the motion
// of its pixels is measured once, its vectors are put into each form in turn, and the ranking is asked what they mean.
// Usage: measure_conventions NAME PATTERN FRAMES X Y ENCODING X Y ENCODING, where ENCODING is down or up, first the
// vectors to the previous frame, then those to the next; "negated" before the second encoding turns them round.
// Prints two lines, for one pair of channels stored and for both: NAME,pairs,ways,one reading,same here,told by names
// among those,left open,silent,wrong,worst of what is wrong.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "motion/joined_pairs.h"
#include "motion/rank_hypotheses.h"
#include "stages/probe_motion.h"
#include "stages/reading_options.h"

namespace varve {
namespace {

struct Source {
  std::string x, y;
  double sign_x = 1, sign_y = 1;
};

int channel_of(const VectorLayer& layer, const std::string& name) {
  for (std::size_t i = 0; i < layer.names.size(); ++i)
    if (layer.names[i] == name) return int(i);
  return -1;
}

/// The motion that a source stores, here and there.
std::vector<std::pair<glm::dvec2, glm::dvec2>> motion_of(const FollowedFrames& frames, const Source& source) {
  for (const FollowedLayer& layer : frames.layers) {
    const int x = channel_of(layer.layer, source.x), y = channel_of(layer.layer, source.y);
    if (x < 0 || y < 0) continue;
    std::vector<std::pair<glm::dvec2, glm::dvec2>> motion;
    for (const FollowedPlace& p : layer.places) {
      const auto at = [&](const StoredValues& v) {
        return glm::dvec2(source.sign_x * double(v[std::size_t(x)]), source.sign_y * double(v[std::size_t(y)]));
      };
      motion.push_back({at(p.here), at(p.there)});
    }
    return motion;
  }
  throw Failure(ExitCode::inconsistent, "no layer holds " + source.x + " and " + source.y);
}

void store(StoredValues& values, const VectorHypothesis& h, const glm::dvec2& motion, const glm::dvec2& jitter,
           const Window& display) {
  const MotionEncoding& e = h.encoding;
  const double share = e.unit == MotionUnit::ndc ? 0.5 : 1.0;
  const double unit_x = e.unit == MotionUnit::pixel ? 1 : share * display.width();
  const double unit_y = e.unit == MotionUnit::pixel ? 1 : share * display.height();
  const glm::dvec2 with = motion + double(h.jitter) * jitter;
  values[std::size_t(h.x)] = float(e.bias + e.sign_x * with.x / (e.scale * unit_x));
  values[std::size_t(h.y)] = float(e.bias + e.sign_y * with.y / (e.scale * unit_y));
}

constexpr double kScale = 0.03;  // a measured scale is right to within 3 %

bool same(const VectorHypothesis& a, const VectorHypothesis& b, const Window& display) {
  const auto factor = [&](const VectorHypothesis& h, bool x) {
    const MotionEncoding& e = h.encoding;
    const double edge = x ? display.width() : display.height();
    const double unit = e.unit == MotionUnit::pixel ? 1 : e.unit == MotionUnit::ndc ? edge / 2 : edge;
    return (x ? e.sign_x : e.sign_y) * e.scale / e.shutter * unit;
  };
  return a.x == b.x && a.jitter == b.jitter && a.encoding.direction == b.encoding.direction &&
         a.encoding.bias == b.encoding.bias && std::abs(factor(a, true) / factor(b, true) - 1) < kScale &&
         std::abs(factor(a, false) / factor(b, false) - 1) < kScale;
}

std::vector<VectorHypothesis> injected() {
  struct Form {
    MotionUnit unit;
    double bias, scale;
  };
  using enum MotionUnit;
  // The last three: open shutters of a half and of a quarter, and a maximum displacement of 40 px.
  constexpr Form kForms[] = {{pixel, 0, 1},  {unit, 0, 1},   {ndc, 0, 1},     {pixel, 0.5, 2},
                             {unit, 0.5, 1}, {unit, 0.5, 2}, {ndc, 0.5, 1},   {pixel, 0.5, 512},
                             {pixel, 0, 2},  {pixel, 0, 4},  {pixel, 0.5, 80}};
  std::vector<VectorHypothesis> all;
  for (const Form& form : kForms)
    for (const MotionDirection direction : {MotionDirection::previous, MotionDirection::next})
      for (const bool swapped : {false, true})
        for (const double sign_x : {1.0, -1.0})
          for (const double sign_y : {1.0, -1.0})
            for (const int jitter : {0, 1}) {
              if (jitter != 0 && (form.unit != pixel || form.bias != 0 || form.scale != 1)) continue;
              VectorHypothesis h;
              h.x = swapped;
              h.y = !swapped;
              h.encoding = {form.bias, form.scale, 1, sign_x, sign_y, form.unit, direction};
              h.jitter = jitter;
              all.push_back(h);
            }
  return all;
}

struct Count {
  int single = 0, same = 0, by_names = 0, open = 0, silent = 0, wrong = 0;
  std::string worst;
};

/// What is known of a shot: its places, the motion there, and the jitter of its frames.
struct Known {
  FollowedFrames followed;
  std::vector<std::pair<glm::dvec2, glm::dvec2>> backward, forward;
  std::map<int, glm::dvec2> jitter;

  glm::dvec2 change(int from, int to) const {
    return jitter.contains(from) && jitter.contains(to) ? jitter.at(from) - jitter.at(to) : glm::dvec2(0);
  }
};

/// The vectors of the shot, stored as a reading has them, put into its channels.
void inject(std::vector<FollowedPlace>& places, const VectorHypothesis& truth, const Known& known) {
  const bool to_previous = truth.encoding.direction == MotionDirection::previous;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [earlier, later] = known.followed.pairs[std::size_t(places[i].pair)];
    // Where a sample was, minus where it will be found: the change of jitter is added as it is seen from each frame.
    const glm::dvec2 here = to_previous ? known.change(later, earlier) : known.change(later, later + 1);
    const glm::dvec2 there = to_previous ? known.change(earlier, earlier - 1) : known.change(earlier, later);
    const auto& motion = (to_previous ? known.backward : known.forward)[i];
    store(places[i].here, truth, motion.first, here, known.followed.display);
    store(places[i].there, truth, motion.second, there, known.followed.display);
  }
}

/// The same way of storing for the other side, in the channels after the first two.
VectorHypothesis other_side(VectorHypothesis h, bool negated) {
  h.x += 2, h.y += 2;
  h.encoding.direction =
      h.encoding.direction == MotionDirection::previous ? MotionDirection::next : MotionDirection::previous;
  if (negated) h.encoding.sign_x = -h.encoding.sign_x, h.encoding.sign_y = -h.encoding.sign_y;
  return h;
}

/// A layer with the names that a convention of the table has for such vectors, if one has.
bool name_channels(VectorLayer& layer, const VectorHypothesis& h) {
  const std::vector<std::string_view> rows = conventions_like(h.encoding);
  if (rows.empty()) return false;
  const MotionConvention& row = *find_motion_convention(rows.front());
  const bool previous = h.encoding.direction == MotionDirection::previous;
  const std::string x(previous ? row.backward_x : row.forward_x), y(previous ? row.backward_y : row.forward_y);
  layer.name = x.find('.') != std::string::npos ? x.substr(0, x.find('.'))
                                                : std::string(row.layers.substr(0, row.layers.find(',')));
  layer.names.assign(4, "");
  layer.names[std::size_t(h.x)] = x;
  layer.names[std::size_t(h.y)] = y;
  return true;
}

void judge(Count& count, const ChannelRanking& ranking, const VectorHypothesis& truth, const Window& display) {
  bool first = false, among = false;
  for (std::size_t k = 0; k < ranking.ranking.size(); ++k) {
    if (!same(ranking.ranking[k].hypothesis, truth, display)) continue;
    first = first || k == 0;
    among = among || k == 0 || ranking.ranking[k].rival;
  }
  const bool found = ranking.finding == VectorFinding::found, open = ranking.finding == VectorFinding::ambiguous;
  if (!found && !open) {
    ++count.silent;
    if (std::getenv("CONVENTIONS_VERBOSE"))
      std::fprintf(stderr, "silent %d: %s%s\n", int(ranking.finding), words_of(truth).c_str(),
                   truth.x == 1 ? " (swapped)" : "");
    return;
  }
  bool wrong = found ? !first : !among;
  VectorLayer layer;
  if (!wrong && open && name_channels(layer, truth))
    if (const std::optional<NamedReading> named = reading_by_names(layer, ranking)) {
      wrong = !same(named->hypothesis, truth, display);
      count.by_names += !wrong;
    }
  if (wrong) {
    ++count.wrong;
    if (count.worst.empty())
      count.worst = words_of(truth) + (truth.x == 1 ? " (swapped)" : "") + " taken for " +
                    words_of(ranking.ranking.front().hypothesis) +
                    (ranking.ranking.front().hypothesis.x == 1 ? " (swapped)" : "");
  } else if (found) {
    ++count.single;
  } else {
    ++(same_here(ranking) ? count.same : count.open);
  }
}

void print(const std::string& name, const char* pairs, std::size_t ways, const Count& count) {
  std::printf("%s,%s,%zu,%d,%d,%d,%d,%d,%d,%s\n", name.c_str(), pairs, ways, count.single, count.same, count.by_names,
              count.open, count.silent, count.wrong, count.worst.c_str());
}

int run(const std::vector<std::string>& arguments) {
  ResolveJob job;
  job.input.color = SequencePattern::parse(arguments[1]);
  const std::vector<int> frames = parse_frame_list(arguments[2]);
  const Source previous{arguments[3], arguments[4], 1, arguments[5] == "up" ? -1.0 : 1.0};
  const double turn = arguments[8].starts_with("negated-") ? -1 : 1;
  const Source next{arguments[6], arguments[7], turn, turn * (arguments[8].ends_with("up") ? -1.0 : 1.0)};

  Workers workers;
  Known known{follow_frames(job, frames, {}, workers), {}, {}, {}};
  known.backward = motion_of(known.followed, previous);
  known.forward = motion_of(known.followed, next);
  for (const int frame : frames)
    if (const FrameHeaders headers =
            read_frame_headers(job.input, frame, without_vectors({}), parse_jitter_source("auto"));
        headers.jitter)
      known.jitter[frame] = glm::dvec2(headers.jitter->x, headers.jitter->y);

  const Window& display = known.followed.display;
  const std::vector<VectorHypothesis> all = injected();
  std::vector<Count> alone(all.size()), joined(all.size());
  workers.for_each(all.size(), [&](std::size_t i, int) {
    const VectorHypothesis& truth = all[i];
    // As renderers with one sign for both sides store them; every third as Cycles does.
    const VectorHypothesis other = other_side(truth, i % 3 == 0);
    std::vector<FollowedPlace> places = known.followed.layers.front().places;
    inject(places, truth, known);
    inject(places, other, known);
    ChannelRanking first = rank_hypotheses(places, 0, 1, display);
    judge(alone[i], first, truth, display);
    ChannelRanking second = rank_hypotheses(places, 2, 3, display);
    if (!first.ranking.empty() && !second.ranking.empty())
      settle_joined(first, second, join_pairs(places, {0, 1}, {2, 3}, first.ranking.front().hypothesis.encoding.bias));
    judge(joined[i], first, truth, display);
  });
  const auto sum = [](const std::vector<Count>& counts) {
    Count total;
    for (const Count& c : counts) {
      total.single += c.single, total.same += c.same, total.by_names += c.by_names, total.open += c.open;
      total.silent += c.silent, total.wrong += c.wrong;
      if (total.worst.empty()) total.worst = c.worst;
    }
    return total;
  };
  const Count by_one = sum(alone), by_both = sum(joined);
  print(arguments[0], "one", all.size(), by_one);
  print(arguments[0], "both", all.size(), by_both);
  return by_one.wrong + by_both.wrong > 0;
}

}  // namespace
}  // namespace varve

int main(int count, char** words) {
  if (count != 10) {
    std::fputs("usage: measure_conventions NAME PATTERN FRAMES X Y up|down X Y [negated-]up|down\n", stderr);
    return 2;
  }
  try {
    return varve::run(std::vector<std::string>(words + 1, words + count));
  } catch (const varve::Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return int(failure.code());
  }
}
