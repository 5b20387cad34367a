// Where in its pixel each frame was sampled: from a sidecar, from the header, or from a named sequence.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "exr/file_header.h"

namespace varve {

/// Sample position minus pixel centre, pixels, y down.
struct Jitter {
  double x = 0, y = 0;
};

/// What `--jitter` names: `auto`, `none`, a CSV file (frame,jx,jy), or a sequence such as `halton23:16`
/// (the index of frame f is f modulo the length, 1-based as renderers count: f = 1 is the first point).
struct JitterSource {
  enum class Kind { automatic, none, table, halton23 } kind = Kind::automatic;
  std::map<int, Jitter> table;
  int length = 16;
  std::string description;  ///< for probe and logs: where the numbers come from
};

/// Throws Failure(usage) for an unknown name, Failure(input) with path and line for a bad CSV.
JitterSource parse_jitter_source(const std::string& text);

/// Jitter of a frame; none when the source does not know it. `automatic` reads the attribute `jitter` (v2f) and the
/// JSON in Cycles' `Note` of the part, and nothing else.
std::optional<Jitter> jitter_of(const JitterSource& source, const Part& part, int frame);

}  // namespace varve
