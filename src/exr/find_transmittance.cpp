// What a layer lets through, where channels of its own say so.

#include <algorithm>

#include "base/error.h"
#include "exr/channel_index.h"

namespace varve {
namespace {

/// Base names of a scalar or of red, green and blue, in the layer itself or in a layer "transmittance" below it.
struct Names {
  bool below;  // in LAYER.transmittance
  bool opacity;
  std::array<std::string_view, 3> bases;
};

constexpr Names kNames[] = {
    {true, false, {"r", "g", "b"}},    {true, false, {"x", "x", "x"}},
    {true, false, {"a", "a", "a"}},    {false, false, {"tr", "tg", "tb"}},
    {false, true, {"ar", "ag", "ab"}}, {false, true, {"ra", "ga", "ba"}},
    {false, false, {"t", "t", "t"}},   {false, false, {"transmittance", "transmittance", "transmittance"}},
};

bool is_below(const ChannelGroup& group, const std::string& layer) {
  if (group.path.empty() || lower_case(group.path.back()) != "transmittance") return false;
  return lower_case(join_path(std::span(group.path).first(group.path.size() - 1))) == layer;
}

bool is_layer(const ChannelGroup& group, const ChannelGroup& color, const std::string& layer) {
  return &group == &color || lower_case(join_path(group.path)) == layer;
}

}  // namespace

void find_transmittance(const ChannelIndex& index, const ChannelGroup& color, const LayersRequest& request,
                        Subject& subject) {
  if (request.mode == LayersMode::apart || request.transmittance == TransmittanceKind::alpha) return;
  const std::string layer = lower_case(subject.layer);
  for (const Names& names : kNames)
    for (const ChannelGroup& group : index.groups) {
      const bool here = names.below ? is_below(group, layer) : is_layer(group, color, layer);
      if (!here || group.view != color.view) continue;
      TransmittanceChannels found;
      bool all = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::optional<ChannelRef> ref = group.find(names.bases[k]);
        all = all && ref;
        if (ref) found.channels[k] = *ref;
      }
      if (!all) continue;
      found.opacity = names.opacity;
      found.cumulative = request.transmittance == TransmittanceKind::cumulative;
      subject.transmittance = found;
      const bool scalar = found.channels[0] == found.channels[1];
      subject.notes.push_back(
          "transmittance of layer " + subject.layer + ": " + index.name(found.channels[0]) +
          (scalar ? "" : ", " + index.name(found.channels[1]) + ", " + index.name(found.channels[2])) +
          (found.opacity ? ", told to be opacity by its name" : ", told by its name") +
          (found.cumulative ? ", of the layer and all in front of it, as given"
           : request.transmittance == TransmittanceKind::layer
               ? ", of the layer by itself, as given"
               : "; taken to be of the layer by itself, give --transmittance cumulative if it is not"));
      return;
    }
  if (request.transmittance != TransmittanceKind::automatic)
    throw Failure(ExitCode::inconsistent, index.files.front().path + ": --transmittance asks for channels, and layer " +
                                              subject.layer + " has none: they would be called " + subject.layer +
                                              ".T, " + subject.layer + ".transmittance.R or " + subject.layer +
                                              ".AR; give --transmittance alpha");
  subject.notes.push_back("transmittance of layer " + subject.layer + ": " +
                          (subject.color[3] ? "one minus its alpha, no channel tells it apart"
                                            : "none, the layer has no alpha and covers all behind it"));
}

}  // namespace varve
