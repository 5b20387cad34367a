// From the channels of a frame to what the passes work on: float, canonical conventions, sanitized.
#pragma once

#include <optional>

#include "exr/channel_names.h"
#include "exr/color_space.h"
#include "exr/read_frame.h"
#include "motion/motion.h"
#include "plan/probe.h"
#include "resolve/present.h"
#include "stages/flatten_deep.h"

namespace varve {

/// Pixels of a frame, one entry per file (FrameHeaders::files).
using FileSet = std::vector<FramePixels>;

/// What of a frame's files is read besides the colors of its subjects and their companions. Parts
/// without any of these never are.
struct ChannelNeeds {
  bool depth = false, motion = false;
  bool whole_parts = false;  ///< every channel of the parts that hold a color or a companion
  bool forward = false;      ///< vectors to the next frame, even where there are others
  bool id = false, normal = false, reactive = false, responsive = false;
  LayerRule rule = LayerRule::variation;  ///< which sample a deep pixel follows
  bool show_combined = false;             ///< and which it was
};

/// Reads what a frame needs, each channel once; deep parts are flattened, colors of subjects as float, and told of in
/// `deep`. Throws what read_channels and read_deep throw.
FileSet read_files(const FrameHeaders& headers, const ChannelNeeds& needs, DeepFrame& deep, Workers& workers);

struct ReadOptions {
  MotionParameters motion;
  bool use_depth = false;  ///< depth is decoded and kept with the present
  bool use_motion = false;
  bool use_forward = false;  ///< vectors to the next frame too, where the file has them
  bool use_id = false, use_normal = false, use_reactive = false, use_responsive = false;  ///< likewise
};

/// Converts one subject; vectors stay as stored, those to the next frame are read where they are asked for or are all
/// there is. `into_working_space` may be null. `vectors_bad` counts vectors that cannot be used.
Present read_present(const Subject& subject, const FileSet& pixels, const Window& window, const Window& display_window,
                     const ReadOptions& options, const ColorConversion* into_working_space, std::size_t& vectors_bad,
                     Workers& workers);

/// Stored vectors over `window` in pixels, y down; NaN where their own window has none, and where they cannot be used.
Plane<glm::vec2> read_vectors(const VectorChannels& channels, const MotionEncoding& encoding, const FileSet& files,
                              const Window& window, const Window& display_window, double max_length,
                              std::size_t& unusable, Workers& workers);

}  // namespace varve
