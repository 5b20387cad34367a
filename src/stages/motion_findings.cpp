#include "stages/motion_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace varve {
namespace {

std::string number(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string percent(double share) { return number(std::round(share * 1000) / 10) + " %"; }

PixelType type_of(const FrameHeaders& headers, ChannelRef ref) {
  return headers.files[std::size_t(ref.file)].parts[std::size_t(ref.part)].channels[std::size_t(ref.channel)].type;
}

/// Pixels of one stored unit along x or y, by what was found or is said of the channels; 0 where nothing is.
double pixels_per_unit(const VectorReport& report, bool along_x, const Window& display) {
  const VectorHypothesis* h = nullptr;
  if (!report.ranking.ranking.empty() &&
      (report.ranking.finding == VectorFinding::found || report.ranking.finding == VectorFinding::ambiguous))
    h = &report.ranking.ranking.front().hypothesis;
  else if (report.given)
    h = &report.given->hypothesis;
  if (!h) return 0;
  const MotionEncoding& e = h->encoding;
  const double edge = along_x ? display.width() : display.height();
  const double unit = e.unit == MotionUnit::pixel ? 1 : e.unit == MotionUnit::ndc ? edge / 2 : edge;
  return std::abs(e.scale / e.shutter) * unit;
}

void about_values(const VectorLayer& layer, const VectorReport& report, const FrameHeaders& headers,
                  const Window& display, std::vector<std::string>& found) {
  const VectorCensus& census = report.census;
  for (const int c : {0, 1}) {
    const std::size_t at = std::size_t(c == 0 ? report.ranking.x : report.ranking.y), k = std::size_t(c);
    const std::string& name = layer.names[at];
    if (census.pixels == census.not_finite) continue;
    if (census.constant(c))
      found.push_back(name + " is " + number(census.least[k]) +
                      " in every pixel: a plain pan, or nothing was written but a bias");
    if (census.clamped(c)) {
      const auto& ends = census.piles[k];
      const Pile& pile = ends[0].at > ends[1].at ? ends[0] : ends[1];
      found.push_back(name + " looks clamped: " + std::to_string(pile.at) + " pixels hold exactly " +
                      number(pile.value) + ", and hardly any comes near it; what moves faster has a wrong vector");
    }
    const double longest = std::max(std::abs(census.least[k]), std::abs(census.greatest[k]));
    const double scale = pixels_per_unit(report, c == 0, display);
    if (type_of(headers, layer.channels[at]) == PixelType::float16 && longest > 0 && scale > 0) {
      const double step = std::exp2(std::floor(std::log2(longest)) - 10) * scale;
      if (step > 1.0 / 32)
        found.push_back(name + " is stored as half and reaches " + number(longest * scale) + " px, where its step is " +
                        number(step) + " px: store vectors as float");
    }
  }
}

}  // namespace

std::vector<std::string> vector_findings(const VectorLayer& layer, const VectorReport& report,
                                         const FrameHeaders& headers, const Window& display) {
  std::vector<std::string> found;
  const VectorCensus& census = report.census;
  const std::string pair =
      layer.names[std::size_t(report.ranking.x)] + ", " + layer.names[std::size_t(report.ranking.y)];
  if (census.all_zero()) {
    found.push_back(pair + ": every vector is zero in " + std::to_string(census.frames) + " frames" +
                    (report.picture_moves
                         ? ", and the picture moves: the renderer wrote none; Cycles does so when motion blur is on"
                         : "; nothing that can be followed moves either"));
    return found;
  }
  about_values(layer, report, headers, display, found);
  if (census.not_finite > 0)
    found.push_back(pair + ": " + std::to_string(census.not_finite) + " vectors are not finite");
  if (census.premultiplied())
    found.push_back(pair + ": premultiplied by alpha: at " +
                    percent(double(census.weighed_by_alpha) / double(census.weighed_by_alpha + census.not_weighed)) +
                    " of the partly covered pixels the vector is as much shorter as they are covered");
  else if (census.antialiased())
    found.push_back(pair + ": antialiased: " +
                    percent(double(census.mixed_edges) / double(census.mixed_edges + census.sharp_edges)) +
                    " of the edges hold vectors between those of both sides, which lead to neither; render vectors "
                    "without a pixel filter");
  const std::size_t moving = report.ranking.rest.moving;
  if (moving >= kFewestPlaces && report.ranking.without_vector * 20 > moving)
    found.push_back(pair + ": " + percent(std::min(1.0, double(report.ranking.without_vector) / double(moving))) +
                    " of the places that move have a vector of zero: a background or things without vectors");
  return found;
}

}  // namespace varve
