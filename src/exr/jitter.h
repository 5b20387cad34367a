// Where in its pixel each frame was sampled: from a sidecar, from the header, or from a named sequence.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exr/file_header.h"
#include "exr/jitter_pattern.h"

namespace varve {

/// What `--jitter` names: `auto`, `none`, `pixels`, a CSV file (frame,jx,jy), or a pattern such as `halton23:16`
/// (the index of frame f is f modulo the length, 1-based as renderers count: f = 1 is the first point); or
/// `auto,PATTERN`: what the frames say, else the pattern.
struct JitterSource {
  enum class Kind { automatic, none, table, pattern, pixels } kind = Kind::automatic;
  std::map<int, Jitter> table;                    ///< by frame, of sample 0
  std::map<std::pair<int, int>, Jitter> further;  ///< by frame and sample, of the others
  bool by_sample = false;                         ///< the table has a column for samples
  const JitterPattern* pattern = nullptr;         ///< of automatic: what is assumed where the frames do not tell
  std::vector<Jitter> points;                     ///< of the pattern, with seed and direction 0
  std::string description;                        ///< for probe and logs: where the numbers come from
};

/// Throws Failure(usage) for an unknown name, Failure(input) with path and line for a bad CSV.
JitterSource parse_jitter_source(const std::string& text);

/// The same source with `samples` points for each frame, where it is a pattern: those of frame 1 come first.
JitterSource with_samples(JitterSource source, int samples);

/// Point of a pattern for a frame: the first one for frame 1, before and after that in turns.
Jitter pattern_point(std::span<const Jitter> points, int frame);

/// Jitter of a frame; none when the source does not know it. `automatic` reads the attribute `jitter` (v2f) and the
/// JSON in Cycles' `Note` of the part, and nothing else. `pixels` knows none: it has to be measured first.
std::optional<Jitter> jitter_of(const JitterSource& source, const Part& part, int frame);

/// The same of one of `samples` samples in each pixel, whose part is `part`. A pattern gives the first frame its first
/// `samples` points, and so on: `source` must have been made by with_samples(). A table without a column for samples
/// knows none of them.
std::optional<Jitter> jitter_of_sample(const JitterSource& source, const Part& part, int frame, int sample,
                                       int samples);

}  // namespace varve
