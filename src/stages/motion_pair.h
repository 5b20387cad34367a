// Two neighboring frames, read to hold vectors against pixels.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "exr/vector_layers.h"
#include "motion/hypotheses.h"
#include "motion/patch_match.h"
#include "stages/read_present.h"

namespace varve {

/// One frame of one subject with its vectors as stored.
struct FrameVectors {
  Present present;  ///< color, depth and id; no motion
  std::vector<VectorLayer> layers;
  std::vector<std::vector<Plane<float>>> values;  ///< of each layer's channels, over their own windows
  Window display;
};

/// What of a frame is read besides color and vectors.
struct VectorNeeds {
  bool marks = false;                       ///< depth and id
  bool vectors = true;                      ///< all layers that may hold vectors
  std::optional<VectorChannels> only = {};  ///< or just these, as a layer of two channels
};

/// Reads subject `k` of a frame whose headers were read with without_vectors().
FrameVectors read_frame_vectors(const FrameHeaders& headers, std::size_t k, const MotionParameters& motion,
                                const VectorNeeds& needs, Workers& workers);

/// Values of a layer at a place: NaN where they are not finite, or differ within `radius` of it by more than a tenth of
/// `ranges`, since then two surfaces meet there.
StoredValues values_at(const std::vector<Plane<float>>& channels, const std::vector<double>& ranges, int x, int y,
                       int radius);
/// The same between pixels, bilinear; pixel (x, y) lies at (x, y).
StoredValues values_between(const std::vector<Plane<float>>& channels, const std::vector<double>& ranges,
                            const glm::dvec2& at, int radius);

/// Range of each channel without its outermost thousandth on either side: small things that move count.
std::vector<double> ranges_of(const std::vector<Plane<float>>& channels);

/// Neighboring frames among `frames`, the least distance apart that occurs, at most `count` pairs spread evenly;
/// (earlier, later).
std::vector<std::pair<int, int>> frame_pairs(const std::vector<int>& frames, int count);

}  // namespace varve
