// Writes what `probe --motion` finds when a sequence with right vectors had them stored in every other way: the motion
// of its pixels is measured once, its vectors are put into each form in turn, and the ranking is asked what they mean.
// Usage: measure_conventions NAME PATTERN FRAMES X Y ENCODING X Y ENCODING, where ENCODING is down or up, first the
// vectors to the previous frame, then those to the next; "negated" before the second encoding turns them round.
// Prints one line: NAME,hypotheses,single,left open,silent,wrong,worst of what is wrong.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "motion/rank_hypotheses.h"
#include "stages/probe_motion.h"

namespace varve {
namespace {

/// Motion of a place in pixels, y down, to the previous and to the next frame.
struct Truth {
  FollowedPlace place;
  glm::dvec2 here_previous, here_next, there_previous, there_next;
};

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

StoredValues stored(const VectorHypothesis& h, const glm::dvec2& motion, const glm::dvec2& jitter,
                    const Window& display) {
  const MotionEncoding& e = h.encoding;
  const double share = e.unit == MotionUnit::ndc ? 0.5 : 1.0;
  const double unit_x = e.unit == MotionUnit::pixel ? 1 : share * display.width();
  const double unit_y = e.unit == MotionUnit::pixel ? 1 : share * display.height();
  const glm::dvec2 with = motion + double(h.jitter) * jitter;
  StoredValues values;
  values.fill(std::nanf(""));
  values[std::size_t(h.x)] = float(e.bias + e.sign_x * with.x / (e.scale * unit_x));
  values[std::size_t(h.y)] = float(e.bias + e.sign_y * with.y / (e.scale * unit_y));
  return values;
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
  int single = 0, open = 0, silent = 0, wrong = 0;
};

int run(const std::vector<std::string>& arguments) {
  ResolveJob job;
  job.input.color = SequencePattern::parse(arguments[1]);
  const std::vector<int> frames = parse_frame_list(arguments[2]);
  const Source previous{arguments[3], arguments[4], 1, arguments[5] == "up" ? -1.0 : 1.0};
  const bool negated = arguments[8].starts_with("negated-");
  const double turn = negated ? -1 : 1;
  const Source next{arguments[6], arguments[7], turn, turn * (arguments[8].ends_with("up") ? -1.0 : 1.0)};

  Workers workers;
  const FollowedFrames followed = follow_frames(job, frames, {}, workers);
  const auto backward = motion_of(followed, previous), forward = motion_of(followed, next);
  std::map<int, glm::dvec2> jitter;
  for (const int frame : frames)
    if (const FrameHeaders headers =
            read_frame_headers(job.input, frame, without_vectors({}), parse_jitter_source("auto"));
        headers.jitter)
      jitter[frame] = glm::dvec2(headers.jitter->x, headers.jitter->y);

  Count count;
  std::string worst;
  const std::vector<VectorHypothesis> all = injected();
  for (const VectorHypothesis& truth : all) {
    std::vector<FollowedPlace> places;
    for (std::size_t i = 0; i < followed.layers.front().places.size(); ++i) {
      FollowedPlace place = followed.layers.front().places[i];
      const auto& [earlier, later] = followed.pairs[std::size_t(place.pair)];
      const bool to_previous = truth.encoding.direction == MotionDirection::previous;
      const auto change = [&](int from, int to) {
        return jitter.contains(from) && jitter.contains(to) ? jitter[from] - jitter[to] : glm::dvec2(0);
      };
      // Where a sample was, minus where it will be found: the change of jitter is added as it is seen from each frame.
      const glm::dvec2 here = to_previous ? change(later, earlier) : change(later, later + 1);
      const glm::dvec2 there = to_previous ? change(earlier, earlier - 1) : change(earlier, later);
      place.here = stored(truth, (to_previous ? backward : forward)[i].first, here, followed.display);
      place.there = stored(truth, (to_previous ? backward : forward)[i].second, there, followed.display);
      places.push_back(place);
    }
    const ChannelRanking ranking = rank_hypotheses(places, 0, 1, followed.display);
    bool first = false, among = false;
    for (std::size_t k = 0; k < ranking.ranking.size(); ++k) {
      if (!same(ranking.ranking[k].hypothesis, truth, followed.display)) continue;
      first = first || k == 0;
      among = among || k == 0 || ranking.ranking[k].rival;
    }
    if (ranking.finding == VectorFinding::found)
      ++(first ? count.single : count.wrong);
    else if (ranking.finding == VectorFinding::ambiguous)
      ++(among ? count.open : count.wrong);
    else
      ++count.silent;
    const bool wrong =
        (ranking.finding == VectorFinding::found && !first) || (ranking.finding == VectorFinding::ambiguous && !among);
    if (wrong && worst.empty())
      worst = words_of(truth) + (truth.x == 1 ? " (swapped)" : "") + " taken for " +
              words_of(ranking.ranking.front().hypothesis) +
              (ranking.ranking.front().hypothesis.x == 1 ? " (swapped)" : "");
    if (std::getenv("CONVENTIONS_VERBOSE") && ranking.finding != VectorFinding::found &&
        ranking.finding != VectorFinding::ambiguous)
      std::fprintf(stderr, "silent %d: %s%s, best %s agree %.2f\n", int(ranking.finding), words_of(truth).c_str(),
                   truth.x == 1 ? " (swapped)" : "",
                   ranking.ranking.empty() ? "-" : words_of(ranking.ranking.front().hypothesis).c_str(),
                   ranking.ranking.empty() ? 0.0 : ranking.ranking.front().fit.agreement);
  }
  std::printf("%s,%zu,%d,%d,%d,%d,%s\n", arguments[0].c_str(), all.size(), count.single, count.open, count.silent,
              count.wrong, worst.c_str());
  return count.wrong > 0;
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
