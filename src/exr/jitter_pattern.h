// Where in its pixel each frame can be sampled: the named patterns.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace varve {

/// Sample position minus pixel centre, pixels, y down.
struct Jitter {
  double x = 0, y = 0;
};

struct PatternRequest {
  int length = 16;         ///< points before the pattern repeats
  std::uint64_t seed = 0;  ///< of patterns made by chance; the same seed gives the same points on every machine
  double direction = 0;    ///< of the motion on screen for motion-perpendicular: degrees from +x towards +y (down)
};

/// A row feeds the command jitter, the option --jitter, `varve help patterns`, and the manual.
struct JitterPattern {
  std::string_view name;
  std::string_view meaning, source;
  std::vector<Jitter> (*points)(const PatternRequest&);
  int length;  ///< points that it has; 0: as many as asked for
  int most;    ///< longest that can be asked for; 0 where the length is given
};

/// In the order of help.
std::span<const JitterPattern> jitter_patterns();
const JitterPattern* find_jitter_pattern(std::string_view name);
/// "halton23, hammersley, ...".
std::string jitter_pattern_names();

/// A pattern with its length as text names them: "uniform4", "halton23:16". `length` is 0 where the text has none and
/// the pattern no length of its own.
struct NamedPattern {
  const JitterPattern* pattern = nullptr;
  int length = 0;
};
/// None where the name is none of the table. Throws Failure(usage) for a length that the pattern cannot have.
std::optional<NamedPattern> parse_pattern(std::string_view text);

/// Mean of the points: what it differs from 0 by, the picture is shifted the other way.
Jitter centroid_of(std::span<const Jitter> points);

}  // namespace varve
