// From which input frames an output is made, and what they held.
#pragma once

#include <string>
#include <vector>

#include "stages/input_watch.h"
#include "stages/preflight.h"

namespace varve {

/// Numbers of the frames that schedule[index] is made from, those of an earlier run included.
std::vector<int> frame_numbers_used(const std::vector<ScheduledFrame>& schedule, std::size_t index,
                                    const FrameReach& reach, const StateHead* before);

/// The same frames with what they hold; those not looked at yet are. Throws what print_of() throws.
std::vector<UsedFrame> frames_used(const std::vector<ScheduledFrame>& schedule, std::size_t index,
                                   const FrameReach& reach, const StateHead* before, InputWatch& watch);

/// What the header of an output says of them.
struct Provenance {
  std::string frames;  ///< as a frame list
  std::string inputs;  ///< print over frame numbers and contents, 16 hexadecimal digits
  std::string extra;   ///< extras_used()
};
Provenance provenance_of(const std::vector<UsedFrame>& used, const std::string& extra = "");

/// The files of further samples that schedule[index] is made from: their number, their frames, and a hash of their
/// names; "" without any. What they hold is in the print of their frames.
std::string extras_used(const ExtraSamples& extras, const std::vector<ScheduledFrame>& schedule, std::size_t index,
                        const FrameReach& reach);

}  // namespace varve
