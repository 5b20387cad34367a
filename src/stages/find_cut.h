// Cuts by evidence: does the picture follow from the one before, or is it another shot? And has the light of all of it
// changed by a factor?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "resolve/present.h"

namespace varve {

/// What of a frame tells whether the next one belongs to it: means of square blocks, about 22 along the shorter side
/// and of 8 pixels at least.
struct FrameTrace {
  int frame = 0;
  Window window;                                       ///< of the picture
  int block = 1;                                       ///< edge of a block in pixels
  Plane<float> luma;                                   ///< mean luminance of a block; NaN where nothing is valid
  Plane<glm::vec2> motion;                             ///< to the frame before, of the pixel in the middle; or empty
  Plane<float> error;                                  ///< standard error of the tone of a block
  Plane<float> tone;                                   ///< L / (L + median L) per block: exposure does not matter
  std::vector<float> tones, reds, greens;              ///< sorted, for distances of distributions: tone, r and g shares
  std::optional<std::vector<double>> world_to_camera;  ///< 16 numbers, row major

  bool empty() const { return tone.empty(); }
};

/// `motion` leads to the frame before; empty: none is known. `world_to_camera`: 16 numbers, where they are known.
FrameTrace trace_of(const Present& present, const Plane<glm::vec2>& motion,
                    const std::optional<std::vector<double>>& world_to_camera, int frame, Workers& workers);

/// What was found between two frames.
struct CutEvidence {
  double judged = 0;       ///< share of the blocks that have any structure to compare
  int blocks = 0;          ///< how many these are
  double unexplained = 0;  ///< of those: share that does not look like what its vector leads to, whatever the light
  double distance = 0;     ///< between the distributions of tone and hue, 0 and up (Wasserstein, summed)
  double turned = 0;       ///< degrees between the cameras; 0 where none is known
  bool with_vectors = false;
  bool cut = false;
  std::string sentence;  ///< the same in words
};

/// A cut is a picture that the vectors do not explain and that differs in its colors, or that they explain nowhere.
/// Light that changes alters neither much: blocks are compared by the correlation of their surroundings. `before` may
/// be some frames earlier: `steps` times the vector leads there, as far as motion is even.
CutEvidence judge_cut(const FrameTrace& before, const FrameTrace& now, int steps = 1);

/// How much brighter a frame is than an earlier one, block by block along the vectors.
struct ExposureStep {
  double ratio = 1;   ///< median over the blocks; 1 where nothing can be compared
  double agreed = 0;  ///< share of all blocks that changed by that factor, up to a tenth
};
ExposureStep exposure_step(const FrameTrace& before, const FrameTrace& now, int steps = 1);

}  // namespace varve
