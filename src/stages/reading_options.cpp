#include "stages/reading_options.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <string_view>

namespace varve {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); });
  return out;
}

std::string last_element(std::string_view name) {
  const std::size_t dot = name.find_last_of(".:");
  return lower(dot == std::string_view::npos ? name : name.substr(dot + 1));
}

bool lists(std::string_view commas, const std::string& word) {
  for (std::size_t at = 0; at <= commas.size();) {
    const std::size_t end = std::min(commas.find(',', at), commas.size());
    if (commas.substr(at, end - at) == word) return true;
    at = end + 1;
  }
  return false;
}

// "forward.u" is channel u of layer forward; a bare channel lies in one of the row's layers.
bool is_called(const VectorLayer& layer, const std::string& channel, std::string_view row_channel,
               std::string_view row_layers) {
  if (last_element(channel) != last_element(row_channel)) return false;
  const std::size_t dot = row_channel.find('.');
  if (dot != std::string_view::npos) return last_element(layer.name) == lower(row_channel.substr(0, dot));
  return row_layers.empty() || lists(row_layers, last_element(layer.name));
}

}  // namespace

std::vector<std::string> conventions_of_names(const VectorLayer& layer, const VectorHypothesis& h) {
  const bool previous = h.encoding.direction == MotionDirection::previous;
  std::vector<std::string> names;
  for (const std::string_view name : conventions_like(h.encoding)) {
    const MotionConvention& row = *find_motion_convention(name);
    if (is_called(layer, layer.names[std::size_t(h.x)], previous ? row.backward_x : row.forward_x, row.layers) &&
        is_called(layer, layer.names[std::size_t(h.y)], previous ? row.backward_y : row.forward_y, row.layers))
      names.emplace_back(name);
  }
  return names;
}

std::optional<NamedReading> reading_by_names(const VectorLayer& layer, const ChannelRanking& ranking) {
  if (ranking.finding != VectorFinding::ambiguous || !same_here(ranking)) return std::nullopt;
  std::optional<NamedReading> named;
  for (std::size_t i = 0; i < ranking.ranking.size(); ++i) {
    if (i > 0 && !ranking.ranking[i].rival) continue;
    const VectorHypothesis& h = ranking.ranking[i].hypothesis;
    if (h.scale_free || h.jitter != 0) return std::nullopt;
    const std::vector<std::string> rows = conventions_of_names(layer, h);
    if (rows.empty()) continue;
    if (named) return std::nullopt;
    named = NamedReading{h, rows.front()};
  }
  return named;
}

std::string reading_options(const VectorLayer& layer, const VectorHypothesis& h) {
  const std::vector<std::string> named = conventions_of_names(layer, h);
  if (!named.empty()) return "--convention " + named.front();
  const std::string role = h.encoding.direction == MotionDirection::previous ? "motion" : "forward";
  const std::string map = " --map " + role + ".x=" + layer.names[std::size_t(h.x)] + " --map " + role +
                          ".y=" + layer.names[std::size_t(h.y)];
  const std::vector<std::string_view> rows = conventions_like(h.encoding);
  if (!rows.empty()) return "--convention " + std::string(rows.front()) + map;
  const MotionEncoding& e = h.encoding;
  std::string text = "--convention varve" + map;
  const auto add = [&](const char* option, double value) {
    char words[80];
    std::snprintf(words, sizeof words, " --%s %.6g", option, value);
    text += words;
  };
  if (e.sign_x < 0) text += " --motion-sign-x -1";
  if (e.sign_y < 0) text += " --motion-sign-y -1";
  if (e.unit != MotionUnit::pixel) text += e.unit == MotionUnit::unit ? " --motion-unit unit" : " --motion-unit ndc";
  if (e.bias != 0) add("motion-bias", e.bias);
  if (e.scale / e.shutter != 1) add("motion-scale", e.scale / e.shutter);
  return text;
}

}  // namespace varve
