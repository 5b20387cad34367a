// What happens in a sequence besides motion: cuts, flashes, frames that are held or doubled, steps of exposure.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "plan/resolve_job.h"

namespace varve {

struct SequenceFact {
  enum class Kind { cut, flash, freeze, duplicate, exposure, gap } kind = Kind::cut;
  int frame = 0;         ///< first frame of it; of a gap, the first that is missing
  int until = 0;         ///< last frame of it
  int other = 0;         ///< freeze, duplicate: the frame that is repeated
  double ratio = 1;      ///< exposure, flash: light against the frame before
  std::string evidence;  ///< in words
};
const char* name_of(SequenceFact::Kind);

struct SequenceFacts {
  std::vector<int> frames;          ///< that were looked at
  std::vector<SequenceFact> facts;  ///< by frame

  /// First frames of new shots, with the evidence.
  std::map<int, std::string> cuts() const;
};

/// Reads color and vectors of the main layer of `frames` (ascending) once. A fact of frame f is decided by the frames
/// from f - 3 to f + 2 alone, and the same whatever else is looked at; frames on disk that near are read besides, where
/// they can be. Only repetitions of frames further apart need both to be among `frames`. Throws Failure naming a frame
/// of `frames` that cannot be read. `stop` ends the work early.
SequenceFacts find_facts(const ResolveJob& job, const std::vector<int>& frames, const std::function<bool()>& stop,
                         Workers& workers);

/// For probe.
std::string facts_text(const SequenceFacts& facts);
std::string facts_json(const SequenceFacts& facts);

}  // namespace varve
