#include "stages/probe_motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/median.h"
#include "exr/unknown_convention.h"
#include "motion/moving_places.h"
#include "stages/join_channels.h"
#include "stages/motion_findings.h"
#include "stages/motion_pair.h"

namespace varve {
namespace {

constexpr int kFewestRows = 2 * kPatchRadius + 3;
constexpr std::size_t kEnoughPlaces = 100;
constexpr int kCoarsest = 8;  // px, edge of the largest pixels that motion is measured with

/// The tones of a pair, kept for measuring hypotheses once they are ranked.
struct PairTones {
  Plane<float> here, earlier;
  int pixel = 1;  ///< edge of their pixels, px
};

/// What was collected for a subject over the pairs.
struct Collected {
  struct Layer {
    VectorLayer layer;
    std::vector<FollowedPlace> places;
    std::vector<std::pair<int, int>> channels;  ///< that belong together by their order
    std::vector<VectorCensus> censuses;         ///< of those
  };
  std::vector<PairTones> tones;
  std::vector<Layer> layers;
  std::vector<MotionPair> pairs;
  Window display;
};

Plane<float> alpha_over(const Plane<glm::vec4>& color, const Window& window) {
  Plane<float> alpha(window);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x)
      alpha.at(x, y) = color.window().contains(x, y) ? color.at(x, y).w : 0.0f;
  return alpha;
}

std::vector<std::pair<int, int>> belonging(const VectorLayer& layer) {
  std::vector<std::pair<int, int>> pairs = {{0, 1}};
  if (layer.channels.size() == 4) pairs.push_back({2, 3});
  return pairs;
}

int floor_to(int v, int pixel) { return (v >= 0 ? v : v - pixel + 1) / pixel; }

/// Places of one frame found in another.
struct Followed {
  std::size_t textured = 0;
  std::vector<MatchedPlace> places;  ///< in pixels of the picture
  PairTones tones;
};

using StoredPair = std::pair<const Plane<float>*, const Plane<float>*>;

// On the whole picture, and half as many on what moves unlike the rest by the stored vectors, whatever they mean.
std::vector<Place> places_of(const Plane<float>& tone, int pixel, const std::vector<StoredPair>& stored, int count,
                             Workers& workers) {
  std::vector<Place> places = textured_places(tone, count, workers);
  for (const auto& [x, y] : stored) {
    const std::vector<Place> more = moving_places(tone, pixel, *x, *y, count / 2 / int(stored.size()), places, workers);
    places.insert(places.end(), more.begin(), more.end());
  }
  return places;
}

// On the finest level that holds on to enough places: smooth pictures and noisy ones are followed by coarser ones.
Followed follow_places(const Plane<glm::vec4>& here, const Plane<glm::vec4>& earlier,
                       const std::vector<StoredPair>& stored, int count, Workers& workers) {
  const Window &a = here.window(), &b = earlier.window();
  Followed best;
  if (std::min({a.width(), a.height(), b.width(), b.height()}) < kFewestRows) return best;
  const double middle = middle_brightness(here);
  TonePyramid from = tone_pyramid(here, middle, workers), to = tone_pyramid(earlier, middle, workers);
  const std::size_t levels = std::min(from.levels.size(), to.levels.size());
  for (int pixel = 1; std::size_t(std::bit_width(unsigned(pixel))) <= levels && pixel <= kCoarsest; pixel *= 2) {
    Followed found;
    const std::vector<Place> places = places_of(from.fine(), pixel, stored, count, workers);
    found.textured = places.size();
    found.places = match_places(from, to, places, workers);
    const bool enough = found.places.size() >= kEnoughPlaces;
    if (found.places.size() >= best.places.size()) {
      // Pixel (x, y) of the level covers those of the picture from (pixel * x, pixel * y) on.
      for (MatchedPlace& m : found.places) {
        m.place = {m.place.x * pixel + pixel / 2, m.place.y * pixel + pixel / 2};
        m.moved *= double(pixel);
      }
      found.tones = {from.fine().clone(), to.fine().clone(), pixel};
      best = std::move(found);
    }
    if (enough) break;
    from.levels.erase(from.levels.begin());
    to.levels.erase(to.levels.begin());
  }
  return best;
}

// The layer of the same name, if its channels are the same.
Collected::Layer* layer_like(Collected& all, const VectorLayer& layer) {
  for (Collected::Layer& known : all.layers)
    if (known.layer.name == layer.name && known.layer.names == layer.names) return &known;
  return nullptr;
}

void take_census(Collected::Layer& layer, const std::vector<Plane<float>>& values, const FrameVectors& frame) {
  for (std::size_t i = 0; i < layer.channels.size(); ++i) {
    const Plane<float>& x = values[std::size_t(layer.channels[i].first)];
    const Plane<float>& y = values[std::size_t(layer.channels[i].second)];
    if (x.window() == y.window()) add_frame(layer.censuses[i], x, y, alpha_over(frame.present.color, x.window()));
  }
}

void collect_pair(Collected& all, const FrameHeaders& later, const FrameHeaders& earlier, std::size_t k,
                  const MotionParameters& motion, const MotionProbe& probe, Workers& workers) {
  const FrameVectors here = read_frame_vectors(later, k, motion, {}, workers);
  const FrameVectors there = read_frame_vectors(earlier, k, motion, {}, workers);
  all.display = here.display;
  MotionPair pair{later.frame, earlier.frame, 0, 0, 0, later.jitter && earlier.jitter};
  const glm::dvec2 jitter = pair.jitter_known
                                ? glm::dvec2(later.jitter->x - earlier.jitter->x, later.jitter->y - earlier.jitter->y)
                                : glm::dvec2(0);
  std::vector<StoredPair> stored;
  for (std::size_t i = 0; i < here.layers.size(); ++i)
    for (const auto& [x, y] : belonging(here.layers[i]))
      stored.push_back({&here.values[i][std::size_t(x)], &here.values[i][std::size_t(y)]});
  Followed followed = follow_places(here.present.color, there.present.color, stored, probe.places, workers);
  pair.textured = followed.textured;
  pair.followed = followed.places.size();
  const int index = int(all.pairs.size());
  for (std::size_t i = 0; i < here.layers.size(); ++i) {
    Collected::Layer* layer = layer_like(all, here.layers[i]);
    if (!layer) {
      layer = &all.layers.emplace_back();
      layer->layer = here.layers[i];
      layer->channels = belonging(layer->layer);
      layer->censuses.resize(layer->channels.size());
    }
    take_census(*layer, here.values[i], here);
    const std::vector<double> ranges = ranges_of(here.values[i]);
    const bool same = i < there.layers.size() && there.layers[i].names == here.layers[i].names;
    for (const MatchedPlace& m : followed.places) {
      const int pixel = followed.tones.pixel;
      FollowedPlace place{index, {m.place.x, m.place.y}, m.moved - jitter, jitter, m.difference, double(pixel), {}, {}};
      place.here = values_at(here.values[i], ranges, m.place.x, m.place.y, kPatchRadius * pixel);
      place.there.fill(std::nanf(""));
      if (same)
        place.there =
            values_between(there.values[i], ranges, glm::dvec2(m.place.x, m.place.y) + m.moved, kPatchRadius * pixel);
      layer->places.push_back(place);
    }
  }
  for (const MatchedPlace& m : followed.places) {
    const glm::dvec2 moved = m.moved - jitter;
    pair.moving += moved.x * moved.x + moved.y * moved.y > 1;
  }
  all.pairs.push_back(pair);
  all.tones.push_back(std::move(followed.tones));
}

/// Median difference of the patches along what `predict` says, over places that move.
template <class Predict>
double residual_of(const Collected& all, const std::vector<FollowedPlace>& places, Predict predict) {
  std::vector<double> differences;
  for (const FollowedPlace& place : places) {
    if (!(place.moved.x * place.moved.x + place.moved.y * place.moved.y > 1)) continue;
    const glm::dvec2 moved = predict(place) + place.jitter;
    if (!std::isfinite(moved.x + moved.y)) continue;
    const PairTones& tones = all.tones[std::size_t(place.pair)];
    const std::optional<double> difference =
        patch_difference(tones.here, floor_to(int(place.at.x), tones.pixel), floor_to(int(place.at.y), tones.pixel),
                         tones.earlier, moved / double(tones.pixel));
    differences.push_back(difference.value_or(1.0));
  }
  return upper_median(std::move(differences), -1.0);
}

void measure_residuals(const Collected& all, const std::vector<FollowedPlace>& places, VectorReport& report) {
  report.rest_residual = residual_of(all, places, [](const FollowedPlace&) { return glm::dvec2(0); });
  report.floor_residual = residual_of(all, places, [](const FollowedPlace& place) { return place.moved; });
  for (std::size_t i = 0; i < std::min<std::size_t>(report.ranking.ranking.size(), 8); ++i) {
    RankedHypothesis& ranked = report.ranking.ranking[i];
    ranked.residual = residual_of(
        all, places, [&](const FollowedPlace& place) { return predicted(ranked.hypothesis, place, all.display); });
  }
}

/// What names or options say of two channels of a layer, if anything.
std::optional<VectorHypothesis> told(const Subject& subject, const VectorLayer& layer, int first, int second) {
  for (const bool backward : {true, false}) {
    const std::optional<VectorChannels>& vector = backward ? subject.backward : subject.forward;
    if (!vector) continue;
    const auto place = [&](ChannelRef ref) {
      return int(std::find(layer.channels.begin(), layer.channels.end(), ref) - layer.channels.begin());
    };
    const int x = place((*vector)[0]), y = place((*vector)[1]);
    if (!((x == first && y == second) || (x == second && y == first))) continue;
    VectorHypothesis h;
    h.x = x;
    h.y = y;
    h.encoding = backward ? subject.backward_encoding : subject.forward_encoding;
    h.encoding.direction = backward ? MotionDirection::previous : MotionDirection::next;
    return h;
  }
  return std::nullopt;
}

// Of rough readings that are as good, the one that the names tell.
void prefer_told(ChannelRanking& ranking, const VectorHypothesis& told_reading) {
  for (std::size_t i = 1; i < ranking.ranking.size(); ++i) {
    const MotionEncoding &e = ranking.ranking[i].hypothesis.encoding, &t = told_reading.encoding;
    if (!ranking.ranking[i].rival || e.direction != t.direction || e.sign_x != t.sign_x || e.sign_y != t.sign_y)
      continue;
    std::swap(ranking.ranking[0], ranking.ranking[i]);
    ranking.ranking[0].rival = false;
    ranking.ranking[i].rival = true;
    return;
  }
}

VectorReport judge_channels(const Collected& all, const Collected::Layer& layer, std::pair<int, int> channels,
                            const Subject* told_subject) {
  VectorReport report;
  report.ranking = rank_hypotheses(layer.places, channels.first, channels.second, all.display);
  report.picture_moves =
      report.ranking.rest.moving >= kFewestPlaces && 3 * report.ranking.rest.moving > layer.places.size();
  measure_residuals(all, layer.places, report);
  // Pixels that do not look better along the vectors than at rest contradict the places that were followed.
  if (!report.ranking.ranking.empty() && report.ranking.finding == VectorFinding::found &&
      !(report.ranking.ranking.front().residual < report.rest_residual)) {
    report.ranking.finding = VectorFinding::contradictory;
    report.ranking.confidence = 0;
  }
  const std::optional<VectorHypothesis> given =
      told_subject ? told(*told_subject, layer.layer, channels.first, channels.second) : std::nullopt;
  if (given && report.ranking.finding == VectorFinding::rough) prefer_told(report.ranking, *given);
  if (given) {
    report.given.emplace();
    report.given->hypothesis = *given;
    report.given->fit = fit_of(*given, layer.places, all.display);
    report.given->residual = residual_of(
        all, layer.places, [&](const FollowedPlace& place) { return predicted(*given, place, all.display); });
    report.given_against_rest = votes_against_rest(*given, layer.places, all.display);
    if (!report.ranking.ranking.empty())
      report.first_against_given =
          votes_between(report.ranking.ranking.front().hypothesis, *given, layer.places, all.display);
  }
  for (std::size_t i = 0; i < layer.channels.size(); ++i)
    if (layer.channels[i] == channels) report.census = layer.censuses[i];
  return report;
}

bool says_something(const VectorReport& report) {
  const VectorFinding f = report.ranking.finding;
  return f != VectorFinding::nothing && f != VectorFinding::untestable;
}

VectorLayerReport judge_layer(const Collected& all, const Collected::Layer& layer, const Subject& subject,
                              const Subject* told_subject) {
  VectorLayerReport judged{subject.layer, subject.view, layer.layer, {}};
  for (const std::pair<int, int>& channels : layer.channels)
    judged.channels.push_back(judge_channels(all, layer, channels, told_subject));
  if (std::none_of(judged.channels.begin(), judged.channels.end(), says_something)) {
    // Channels that do not belong together by their order, since those that do say nothing.
    const int n = int(layer.layer.channels.size());
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) {
        if (std::find(layer.channels.begin(), layer.channels.end(), std::pair(i, j)) != layer.channels.end()) continue;
        VectorReport other = judge_channels(all, layer, {i, j}, told_subject);
        if (says_something(other)) judged.channels.push_back(std::move(other));
      }
  }
  return judged;
}

/// Votes of ids and depths in one pair: pixels whose vector leads to another mark than rest does.
void vote_by_marks(VectorReport& report, const VectorLayer& layer, const FrameVectors& later,
                   const FrameVectors& earlier, const glm::dvec2& jitter) {
  const VectorHypothesis& h = report.ranking.ranking.front().hypothesis;
  const bool previous = h.encoding.direction == MotionDirection::previous;
  const FrameVectors &from = previous ? later : earlier, &to = previous ? earlier : later;
  const auto layer_at = std::find_if(from.layers.begin(), from.layers.end(),
                                     [&](const VectorLayer& l) { return l.names == layer.names; });
  if (layer_at == from.layers.end()) return;
  const std::vector<Plane<float>>& values = from.values[std::size_t(layer_at - from.layers.begin())];
  const double turn = previous ? 1 : -1;
  const Window &w = from.present.color.window(), &into = to.present.color.window();
  const int step = std::max(1, int(std::sqrt(double(w.pixels()) / 40000)));
  for (int y = w.y0; y < w.y1; y += step)
    for (int x = w.x0; x < w.x1; x += step) {
      FollowedPlace place;
      place.jitter = jitter;
      StoredValues& at = previous ? place.here : place.there;
      at.fill(std::nanf(""));
      for (std::size_t c = 0; c < values.size() && c < at.size(); ++c)
        if (values[c].window().contains(x, y)) at[c] = values[c].at(x, y);
      if (is_at_rest(h, place)) continue;
      // Prediction leads to the earlier frame; turned round it leads from there to here.
      const glm::dvec2 way = turn * (predicted(h, place, from.display) + jitter);
      if (!(std::abs(way.x) + std::abs(way.y) < 1e6)) continue;
      const int lx = int(std::lround(x + way.x)), ly = int(std::lround(y + way.y));
      const int rx = int(std::lround(x + turn * jitter.x)), ry = int(std::lround(y + turn * jitter.y));
      if (!into.contains(lx, ly) || !into.contains(rx, ry)) continue;
      if (!from.present.id.empty() && !to.present.id.empty()) {
        const std::uint32_t own = from.present.id.at(x, y);
        const bool by_vector = to.present.id.at(lx, ly) == own, by_rest = to.present.id.at(rx, ry) == own;
        report.ids.decided += by_vector != by_rest;
        report.ids.won += by_vector && !by_rest;
      }
      if (!from.present.depth.empty() && !to.present.depth.empty()) {
        const double own = double(from.present.depth.at(x, y));
        const auto like = [&](float z) { return std::abs(double(z) - own) <= 0.05 * std::min(own, double(z)); };
        const bool by_vector = like(to.present.depth.at(lx, ly)), by_rest = like(to.present.depth.at(rx, ry));
        report.depths.decided += by_vector != by_rest;
        report.depths.won += by_vector && !by_rest;
      }
    }
}

bool speaks_against(const MarkVotes& votes) { return votes.decided >= 300 && votes.won * 3 < votes.decided; }

}  // namespace

RoleRequest without_vectors(RoleRequest roles) {
  roles.convention = "none";
  roles.channels.clear();
  std::erase_if(roles.map, [](const auto& entry) {
    return entry.first.starts_with("motion.") || entry.first.starts_with("forward.");
  });
  return roles;
}

std::optional<FrameHeaders> told_by_names(const ResolveJob& job, int frame, const JitterSource& jitter,
                                          std::string* refusal) {
  try {
    return read_frame_headers(job.input, frame, job.roles, jitter);
  } catch (const UnknownConvention& unknown) {
    if (refusal) *refusal = unknown.what();
    return std::nullopt;
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::inconsistent) throw;
    return std::nullopt;
  }
}

FollowedFrames follow_frames(const ResolveJob& job, const std::vector<int>& frames, const MotionProbe& probe,
                             Workers& workers) {
  const JitterSource jitter = parse_jitter_source(job.jitter);
  const RoleRequest roles = without_vectors(job.roles);
  FollowedFrames followed;
  followed.pairs = frame_pairs(frames, probe.pairs);
  Collected all;
  for (const auto& [earlier, later] : followed.pairs)
    collect_pair(all, read_frame_headers(job.input, later, roles, jitter),
                 read_frame_headers(job.input, earlier, roles, jitter), 0, job.parameters.motion, probe, workers);
  followed.display = all.display;
  for (Collected::Layer& layer : all.layers) followed.layers.push_back({layer.layer, std::move(layer.places)});
  return followed;
}

MotionReport probe_motion(const ResolveJob& job, const std::vector<int>& frames, const MotionProbe& probe,
                          Workers& workers) {
  MotionReport report;
  const JitterSource jitter = parse_jitter_source(job.jitter);
  const RoleRequest roles = without_vectors(job.roles);
  const std::vector<std::pair<int, int>> pairs = frame_pairs(frames, probe.pairs);
  if (pairs.empty()) {
    report.notes.push_back("there is one frame only, so nothing shows where its pixels come from");
    return report;
  }
  std::vector<Collected> all;
  std::vector<FrameHeaders> first_headers;
  for (const auto& [earlier, later] : pairs) {
    const FrameHeaders before = read_frame_headers(job.input, earlier, roles, jitter);
    const FrameHeaders now = read_frame_headers(job.input, later, roles, jitter);
    if (all.empty()) {
      all.resize(now.subjects.size());
      first_headers.push_back(now);
    }
    for (std::size_t k = 0; k < all.size() && k < now.subjects.size() && k < before.subjects.size(); ++k)
      collect_pair(all[k], now, before, k, job.parameters.motion, probe, workers);
  }
  report.pairs = all.front().pairs;
  report.display = all.front().display;

  const std::optional<FrameHeaders> told_headers = told_by_names(job, pairs.front().second, jitter);
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const Collected::Layer& layer : all[k].layers)
      report.layers.push_back(
          judge_layer(all[k], layer, first_headers.front().subjects[k],
                      told_headers && k < told_headers->subjects.size() ? &told_headers->subjects[k] : nullptr));
  for (std::size_t k = 0, at = 0; k < all.size(); at += all[k].layers.size(), ++k) {
    std::vector<JudgedChannels> judged;
    for (std::size_t i = 0; i < all[k].layers.size(); ++i)
      for (VectorReport& channels : report.layers[at + i].channels)
        judged.push_back({&all[k].layers[i].places, &channels});
    join_channels(judged);
  }

  // Marks of the first and of the last pair, read again: they are large, and only what was found is held against them.
  if (probe.marks)
    for (const std::size_t p : {std::size_t(0), pairs.size() - 1}) {
      if (p != 0 && pairs.size() == 1) break;
      const FrameHeaders before = read_frame_headers(job.input, pairs[p].first, roles, jitter);
      const FrameHeaders now = read_frame_headers(job.input, pairs[p].second, roles, jitter);
      for (std::size_t k = 0, at = 0; k < all.size(); at += all[k].layers.size(), ++k) {
        const FrameVectors later = read_frame_vectors(now, k, job.parameters.motion, {.marks = true}, workers);
        const FrameVectors earlier = read_frame_vectors(before, k, job.parameters.motion, {.marks = true}, workers);
        const glm::dvec2 change = now.jitter && before.jitter
                                      ? glm::dvec2(now.jitter->x - before.jitter->x, now.jitter->y - before.jitter->y)
                                      : glm::dvec2(0);
        for (std::size_t i = 0; i < all[k].layers.size(); ++i)
          for (VectorReport& channels : report.layers[at + i].channels)
            if (says_something(channels)) vote_by_marks(channels, report.layers[at + i].layer, later, earlier, change);
      }
    }
  for (VectorLayerReport& layer : report.layers)
    for (VectorReport& channels : layer.channels) {
      if (channels.ranking.finding == VectorFinding::found &&
          (speaks_against(channels.ids) || speaks_against(channels.depths))) {
        channels.ranking.finding = VectorFinding::contradictory;
        channels.ranking.confidence = 0;
      }
      channels.findings = vector_findings(layer.layer, channels, first_headers.front(), report.display);
    }
  if (report.layers.empty())
    report.notes.push_back("no layer of two to four float channels is there that could hold vectors");
  const bool jittered =
      std::any_of(report.pairs.begin(), report.pairs.end(), [](const MotionPair& p) { return p.jitter_known; });
  if (!jittered)
    report.notes.push_back(
        "the jitter is not known: if the frames have one, nothing agrees better than by the distance it changes; give "
        "--jitter");
  return report;
}

}  // namespace varve
