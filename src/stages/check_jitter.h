// The jitter as it is stated against the jitter that the pixels show.
#pragma once

#include <string>
#include <vector>

#include "diagnose/jitter_fit.h"
#include "diagnose/sub_pixel_shift.h"
#include "plan/resolve_job.h"

namespace varve {

/// Between two frames that follow each other.
struct NeighborShift {
  int frame = 0;  ///< the later one
  SubPixelShift measured;
  double stuck = 0;  ///< correlation of the finest detail at the same place of the screen where the picture moves
  std::size_t stuck_pixels = 0;
};

struct JitterCheck {
  std::vector<int> frames;  ///< that were read: consecutive numbers
  std::vector<std::optional<glm::dvec2>> stated;
  std::vector<NeighborShift> neighbors;
  std::vector<ShiftBetween> shifts;  ///< between frames up to three apart; only those that tell something
  std::size_t tried = 0;             ///< pairs of frames that were looked at
  OffsetFit fit;
  JitterVerdict verdict;
  bool vectors = false;            ///< motion was followed; else all is taken to be at rest
  bool measurable = false;         ///< the offsets of all frames are known, to about 0.05 px
  std::string why_not;             ///< a sentence, where they are not
  std::string sentence;            ///< what the comparison says, with the remedy
  std::vector<std::string> notes;  ///< seeds that stay, a centroid that is off
};

/// Reads the pixels of `frames` in order; they should follow each other, and only the longest run of them that does is
/// looked at. Throws Failure naming a frame that cannot be read.
JitterCheck check_jitter(const ResolveJob& job, const std::vector<int>& frames, const JitterSource& stated,
                         Workers& workers);

/// The offsets that the pixels show, as a source; throws Failure(inconsistent) with the reason where they do not tell.
JitterSource measured_jitter(const ResolveJob& job, Workers& workers);

/// For probe.
std::string jitter_check_text(const JitterCheck& check);
std::string jitter_check_json(const JitterCheck& check);

}  // namespace varve
