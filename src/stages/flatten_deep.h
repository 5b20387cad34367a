// Channels of a file as flat pixels: those of flat parts as stored, those of deep parts flattened.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "deep/flatten.h"
#include "exr/read_deep.h"
#include "exr/read_frame.h"
#include "plan/probe.h"
#include "resolve/present.h"

namespace varve {

/// What was met in the deep parts of a frame.
struct DeepCounts {
  std::uint64_t pixels = 0, samples = 0;
  std::uint64_t most = 0;  ///< samples in one pixel
  DeepDefects defects;
  DeepCounts& operator+=(const DeepCounts& other);
};

struct FlattenOptions {
  LayerRule rule = LayerRule::variation;
  bool show = false;  ///< DeepFrame::combined is wanted
  DeepLimits limits;
};

/// What is known of the deep parts of a frame besides their flat pixels.
struct DeepFrame {
  DeepCounts counts;
  std::map<int, CombinePlanes> combined;  ///< by part: which sample won, counted from the front, and by how much
};

/// Reads the chosen channels of one file of a frame as read_shown_channels does, deep ones flattened over their data
/// window. Those in `precise` come as float whatever their type; the others keep it. Light is composited, of alpha
/// there is what all samples hide; every other channel has the value of the sample that the pixel follows, and 0, or
/// background where it is a depth, where there is none. ZBack comes out empty. `deep` is added to.
FramePixels read_flat(const FrameHeaders& headers, int file, std::span<const ChannelRef> channels,
                      std::span<const ChannelRef> precise, const FlattenOptions& options, DeepFrame& deep,
                      Workers& workers);

}  // namespace varve
