// Which channels of a deep part say where a sample lies and how much it hides.
#pragma once

#include <array>
#include <optional>

#include "exr/file_header.h"

namespace varve {

/// Places in Part::channels, by name: Z, ZBack, and A, or AR AG AB where each color has an opacity of its own. Bare
/// names come before those of a layer.
struct DeepChannels {
  std::optional<int> z, z_back;
  std::array<std::optional<int>, 4> opacity;  ///< of R, G, B and A; that of A stands in for those that are missing
  bool colored = false;                       ///< the opacities of R, G and B are channels of their own
};
DeepChannels deep_channels(const Part& part);

/// What becomes of a channel when its part is flattened.
enum class DeepRole {
  light,    ///< composited front to back
  opacity,  ///< what all samples hide together
  winner,   ///< the value of the sample that the pixel follows: an average would mean nothing
  none      ///< means nothing in a flat part (ZBack)
};
struct DeepUse {
  DeepRole role = DeepRole::winner;
  std::size_t lane = 3;  ///< the opacity that goes with it: 0 R, 1 G, 2 B, 3 A
};
DeepUse deep_use(const Part& part, int channel);

/// What an empty pixel of a depth channel of that type holds once its part is flat: background. Halves end at 65504.
float deep_background(PixelType type);

}  // namespace varve
