// The table of sample positions that a renderer is given and that varve reads back.
#pragma once

#include <string>

#include "exr/jitter_convention.h"
#include "exr/jitter_pattern.h"

namespace varve {

struct JitterListJob {
  std::string pattern;    ///< with or without its length: "helix4", "halton23:16"
  int count = 16;         ///< frames; also the length of a pattern that has none of its own
  int first = 1;          ///< number of the first frame
  int seed = 0;           ///< of patterns made by chance, 0 and up
  double direction = 0;   ///< see PatternRequest
  double amplitude = 1;   ///< factor on all points: 1 fills the pixel, 0 leaves its center
  bool centered = false;  ///< subtract the centroid
  std::string_view convention = "pixels";
  int width = 0, height = 0;  ///< of the picture, for the conventions that need it
};

struct JitterList {
  std::string name;            ///< of the pattern
  std::vector<Jitter> points;  ///< one round, pixels
  Jitter centroid;             ///< of one round; taken out of the points where that was asked for
  const JitterConvention* convention = nullptr;
};

/// Throws Failure(usage) for an unknown pattern, a length it cannot have, and a size that is missing.
JitterList list_jitter(const JitterListJob& job);

/// Comment lines, a header, and a line for each frame. In the convention pixels it is what parse_jitter_source reads,
/// to the last bit; in others it has other columns and is refused there.
std::string jitter_csv(const JitterListJob& job, const JitterList& list);
std::string jitter_json(const JitterListJob& job, const JitterList& list);

}  // namespace varve
