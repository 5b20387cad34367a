// What was found about vectors, for people and for machines.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "base/words.h"
#include "stages/probe_motion.h"
#include "stages/reading_options.h"

namespace varve {
namespace {

constexpr std::size_t kListed = 6;  // hypotheses of a ranking that people see

std::string number(double value, const char* format = "%.4g") {
  char digits[40];
  std::snprintf(digits, sizeof digits, format, value);
  return digits;
}

std::string percent(double share) { return number(100 * share, "%.0f") + " %"; }

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string names_text(const VectorLayer& layer, const VectorHypothesis& h) {
  return layer.names[std::size_t(h.x)] + ", " + layer.names[std::size_t(h.y)];
}

std::string scale_text(const RankedHypothesis& ranked) {
  if (!ranked.hypothesis.scale_free) return "";
  const FoundScale& s = ranked.scale;
  std::string text = "; the scale " + number(s.scale) + " is measured, give or take " + number(2 * s.deviation, "%.2g");
  if (s.scale_x > 0 && s.scale_y > 0 && std::abs(s.scale_x - s.scale_y) > 0.05 * s.scale)
    text += " (" + number(s.scale_x, "%.3g") + " along x, " + number(s.scale_y, "%.3g") + " along y)";
  if (s.scale > 1.05 && ranked.hypothesis.encoding.bias == 0 && ranked.hypothesis.encoding.unit == MotionUnit::pixel)
    text += ", as an open shutter of " + number(1 / s.scale, "%.3g") + " frames would make it";
  return text;
}

std::vector<std::string> rows_of(const MotionEncoding& encoding) {
  std::vector<std::string> rows;
  for (const std::string_view name : conventions_like(encoding)) rows.emplace_back(name);
  return rows;
}

// From the least to the greatest factor along an axis.
std::string span_text(const std::vector<PairScale>& scales, double PairScale::*axis) {
  double least = 1e300, greatest = 0;
  for (const PairScale& scale : scales)
    if (scale.*axis > 0) least = std::min(least, scale.*axis), greatest = std::max(greatest, scale.*axis);
  if (greatest == 0) return "none";
  return number(least, "%.3g") + (greatest > 1.02 * least ? " to " + number(greatest, "%.3g") : "");
}

// The factors of all pairs together.
std::string scales_text(const std::vector<PairScale>& scales) {
  return "it takes factors of " + span_text(scales, &PairScale::along_x) + " along x and " +
         span_text(scales, &PairScale::along_y) + " along y, as vectors scaled by an open shutter would";
}

const char* name_of(VectorFinding finding) {
  switch (finding) {
    case VectorFinding::found:
      return "found";
    case VectorFinding::rough:
      return "rough";
    case VectorFinding::ambiguous:
      return "ambiguous";
    case VectorFinding::contradictory:
      return "contradictory";
    case VectorFinding::nothing:
      return "nothing";
    case VectorFinding::untestable:
      break;
  }
  return "untestable";
}

std::string ranking_line(const VectorLayer& layer, const RankedHypothesis& ranked, std::size_t rank) {
  std::string text = "    " + number(double(rank), "%2.0f") + "  " + number(100 * ranked.fit.agreement, "%3.0f") +
                     " % agree, off by " + number(ranked.fit.off, "%.2f") + " px";
  if (ranked.residual >= 0) text += ", residual " + number(ranked.residual, "%.3f");
  if (rank > 1)
    text += ranked.rival ? ", not told from the first"
                         : ", loses " + std::to_string(ranked.first_against.won) + " of " +
                               std::to_string(ranked.first_against.decided) + " places";
  return text + "\n" + wrapped("        ", names_text(layer, ranked.hypothesis) + ": " + words_of(ranked.hypothesis));
}

std::string evidence_text(const VectorReport& report) {
  std::string text;
  const auto add = [&](const MarkVotes& votes, const char* what) {
    if (votes.decided > 0)
      text += std::string(text.empty() ? "" : "; ") + what + " agree at " + std::to_string(votes.won) + " of " +
              std::to_string(votes.decided) + " pixels where the vector leads to another one than rest";
  };
  add(report.ids, "ids");
  add(report.depths, "depths");
  return text;
}

std::string given_text(const VectorLayer& layer, const VectorReport& report) {
  const RankedHypothesis& given = *report.given;
  return "as given or told by the names (" + names_text(layer, given.hypothesis) + ": " + words_of(given.hypothesis) +
         "): " + percent(given.fit.agreement) + " agree, off by " + number(given.fit.off, "%.2f") + " px" +
         (given.residual >= 0 ? ", residual " + number(given.residual, "%.3f") : "") + "; better than no motion at " +
         std::to_string(report.given_against_rest.won) + " of " + std::to_string(report.given_against_rest.decided) +
         " places";
}

std::string channels_text(const VectorLayerReport& layer, const VectorReport& report, const Window& display) {
  const ChannelRanking& ranking = report.ranking;
  std::string text =
      wrapped("  ", layer.layer.names[std::size_t(ranking.x)] + ", " + layer.layer.names[std::size_t(ranking.y)] +
                        (layer.layer.by_name ? "" : " (the names do not look like motion)"));
  text += wrapped("    ", "Verdict: " + verdict_text(layer.layer, report, display));
  for (std::size_t i = 0; i < std::min(ranking.ranking.size(), kListed); ++i)
    text += ranking_line(layer.layer, ranking.ranking[i], i + 1);
  if (!ranking.ranking.empty()) {
    text += "     -  residual " + number(report.rest_residual, "%.3f") +
            "\n        no motion; the vectors are nearer at " + std::to_string(ranking.against_rest.won) + " of " +
            std::to_string(ranking.against_rest.decided) + " places\n";
    text += "     -  residual " + number(report.floor_residual, "%.3f") + "\n        best match, the noise floor\n";
  }
  if (report.given && !ranking.ranking.empty()) text += wrapped("    - ", given_text(layer.layer, report));
  if (const std::string evidence = evidence_text(report); !evidence.empty()) text += wrapped("    - ", evidence);
  for (const std::string& finding : report.findings) text += wrapped("    - ", finding);
  return text;
}

std::string residual_json(double residual) { return residual < 0 ? "null" : json_number(residual); }

std::string hypothesis_json(const RankedHypothesis& ranked) {
  const MotionEncoding& e = ranked.hypothesis.encoding;
  const char* unit = e.unit == MotionUnit::pixel ? "pixel" : e.unit == MotionUnit::unit ? "unit" : "ndc";
  return json_object({{"text", json_quote(words_of(ranked.hypothesis))},
                      {"x", std::to_string(ranked.hypothesis.x)},
                      {"y", std::to_string(ranked.hypothesis.y)},
                      {"direction", e.direction == MotionDirection::previous ? "\"previous\"" : "\"next\""},
                      {"unit", json_quote(unit)},
                      {"bias", json_number(e.bias)},
                      {"scale", json_number(e.scale / e.shutter)},
                      {"scale_measured", json_boolean(ranked.hypothesis.scale_free)},
                      {"scale_deviation", json_number(ranked.scale.deviation)},
                      {"scale_x", json_number(ranked.scale.scale_x)},
                      {"scale_y", json_number(ranked.scale.scale_y)},
                      {"sign_x", json_number(e.sign_x)},
                      {"sign_y", json_number(e.sign_y)},
                      {"jitter", std::to_string(ranked.hypothesis.jitter)},
                      {"score", json_number(ranked.fit.score)},
                      {"agreement", json_number(ranked.fit.agreement)},
                      {"off", json_number(ranked.fit.off)},
                      {"residual", residual_json(ranked.residual)},
                      {"rival", json_boolean(ranked.rival)},
                      {"decided", std::to_string(ranked.first_against.decided)},
                      {"won", std::to_string(ranked.first_against.won)},
                      {"conventions", json_array(rows_of(ranked.hypothesis.encoding),
                                                 [](const std::string& row) { return json_quote(row); })}});
}

std::string votes_json(const MarkVotes& votes) {
  return json_object({{"decided", std::to_string(votes.decided)}, {"won", std::to_string(votes.won)}});
}

std::string channels_json(const VectorLayerReport& layer, const VectorReport& report, const Window& display) {
  const ChannelRanking& ranking = report.ranking;
  const auto text = [](const std::string& s) { return json_quote(s); };
  const std::optional<NamedReading> named = reading_by_names(layer.layer, ranking);
  return json_object({{"x", json_quote(layer.layer.names[std::size_t(ranking.x)])},
                      {"y", json_quote(layer.layer.names[std::size_t(ranking.y)])},
                      {"finding", json_quote(name_of(ranking.finding))},
                      {"verdict", json_quote(verdict_text(layer.layer, report, display))},
                      {"confidence", json_number(ranking.confidence)},
                      {"hypotheses", json_array(ranking.ranking, hypothesis_json)},
                      {"rest", json_object({{"agreement", json_number(ranking.rest.agreement)},
                                            {"off", json_number(ranking.rest.off)},
                                            {"residual", residual_json(report.rest_residual)}})},
                      {"floor", residual_json(report.floor_residual)},
                      {"given", report.given ? hypothesis_json(*report.given) : "null"},
                      {"ids", votes_json(report.ids)},
                      {"depths", votes_json(report.depths)},
                      {"by_names", named ? json_quote(named->convention) : "null"},
                      {"same_here", json_boolean(same_here(ranking))},
                      {"joined", json_boolean(ranking.joined)},
                      {"open", json_array(left_open(ranking), text)},
                      {"findings", json_array(report.findings, text)}});
}

}  // namespace

std::string verdict_text(const VectorLayer& layer, const VectorReport& report, const Window&) {
  const ChannelRanking& ranking = report.ranking;
  if (ranking.finding == VectorFinding::untestable)
    return "cannot tell: only " + std::to_string(ranking.rest.moving) +
           " places with texture move by more than a pixel" + " and are found again, and it takes " +
           std::to_string(kFewestPlaces);
  if (ranking.finding == VectorFinding::nothing || ranking.ranking.empty())
    return "nothing wins: no reading of these channels agrees with the motion of the pixels";
  const RankedHypothesis& first = ranking.ranking.front();
  std::vector<std::string> rows = rows_of(first.hypothesis.encoding);
  std::string text = names_text(layer, first.hypothesis) + " lead " + words_of(first.hypothesis) + scale_text(first);
  if (ranking.finding == VectorFinding::rough) {
    MotionEncoding plain = first.hypothesis.encoding;
    plain.scale = 1;
    rows = rows_of(plain);
  }
  const std::string same =
      rows.empty() ? "no convention of the table is like that" : "as convention " + joined(rows, " or ");
  switch (ranking.finding) {
    case VectorFinding::found:
      return text + ": " + same +
             (ranking.joined ? "; which way is told by the other pair of channels, which holds the way back" : "") +
             "; confidence " + number(ranking.confidence, "%.2f");
    case VectorFinding::rough:
      return "roughly, " + text + ": " + same +
             "; no constant scale brings the vectors onto the motion, which may be curved: " +
             scales_text(first.scales) +
             (left_open(ranking).empty() ? "" : "; left open: " + joined(left_open(ranking), ", "));
    case VectorFinding::ambiguous: {
      std::size_t rivals = 0;
      for (const RankedHypothesis& ranked : ranking.ranking) rivals += ranked.rival;
      if (const std::optional<NamedReading> named = reading_by_names(layer, ranking))
        return names_text(layer, named->hypothesis) + " lead " + words_of(named->hypothesis) + ": as convention " +
               named->convention + ", by their names; the pixels allow " + std::to_string(rivals + 1) +
               " readings that lead to the same places in these frames, and leave open: " +
               joined(left_open(ranking), ", ");
      return "cannot tell between " + std::to_string(rivals + 1) +
             (same_here(ranking) ? " readings that lead to the same places here, such as: " : " readings, such as: ") +
             text + " (" + same + "); left open: " + joined(left_open(ranking), ", ");
    }
    default:
      return "contradictory evidence, nothing is chosen; the most agree that " + text + ", and others do not" +
             (ranking.contradicting.empty()
                  ? ""
                  : ", in " + std::to_string(ranking.contradicting.size()) + " of the pairs of frames");
  }
}

std::string motion_text(const MotionReport& report) {
  std::string text = "\nMotion, measured from the pixels\n";
  for (const MotionPair& pair : report.pairs)
    text += "  frames " + std::to_string(pair.earlier) + " and " + std::to_string(pair.frame) + ": " +
            std::to_string(pair.textured) + " places with texture, " + std::to_string(pair.followed) +
            " found again, " + std::to_string(pair.moving) + " move\n";
  for (const VectorLayerReport& layer : report.layers) {
    text += wrapped("  ", (layer.subject.empty() ? std::string("(main)") : layer.subject) +
                              (layer.view.empty() ? "" : ", view " + layer.view) + ": vectors of " +
                              (layer.layer.name.empty() ? "no layer" : "layer " + layer.layer.name));
    for (const VectorReport& channels : layer.channels) text += channels_text(layer, channels, report.display);
  }
  for (const std::string& note : report.notes) text += wrapped("  - ", note);
  return text;
}

std::string motion_json(const MotionReport& report) {
  const std::string pairs = json_array(report.pairs, [](const MotionPair& pair) {
    return json_object({{"frame", std::to_string(pair.frame)},
                        {"earlier", std::to_string(pair.earlier)},
                        {"textured", std::to_string(pair.textured)},
                        {"followed", std::to_string(pair.followed)},
                        {"moving", std::to_string(pair.moving)},
                        {"jitter_known", json_boolean(pair.jitter_known)}});
  });
  const std::string layers = json_array(report.layers, [&](const VectorLayerReport& layer) {
    return json_object({{"layer", json_quote(layer.subject)},
                        {"view", json_quote(layer.view)},
                        {"vectors", json_quote(layer.layer.name)},
                        {"by_name", json_boolean(layer.layer.by_name)},
                        {"channels", json_array(layer.channels, [&](const VectorReport& channels) {
                           return channels_json(layer, channels, report.display);
                         })}});
  });
  return json_object({{"pairs", pairs},
                      {"layers", layers},
                      {"notes", json_array(report.notes, [](const std::string& note) { return json_quote(note); })}});
}

}  // namespace varve
