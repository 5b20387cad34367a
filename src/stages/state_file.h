// Files of --state-out and --state-in: what recursion knows after one frame, so that another run can go on from there
// with the same bits.
//
// Little endian. "varve-st", version of the format (u32), CRC-32 of the head (u32), size of the head (u64), the head,
// then the planes one behind the other, rows without gaps. The head holds texts (u32 size, bytes), numbers, and one
// record for each plane with its name, element, window, size and CRC-32. No time, no path, no name of a machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exr/camera_source.h"
#include "stages/input_watch.h"

namespace varve {

struct SubjectState;

inline constexpr std::uint32_t kStateFormat = 1;

/// What a state is the state of.
struct StateHead {
  std::string version;            ///< of the program that wrote it
  std::string parameters, hash;   ///< of the run; see describe_parameters()
  int first = 0, preroll = 0;     ///< where the history of that run began: part of the parameters
  std::vector<UsedFrame> frames;  ///< the history goes back to the first of them; the last is the frame of the state
  std::vector<std::string> subjects;  ///< layer and view of each thing that is accumulated
  FrameCameras cameras;               ///< of the last frame

  int last() const { return frames.back().frame; }
};

/// A state as it is read.
struct SavedState {
  StateHead head;
  std::vector<SubjectState> subjects;
};

/// The file appears under its name when it is complete. Throws Failure(output).
void write_state(const std::string& path, const StateHead& head, const std::vector<SubjectState>& subjects);

/// Whether a state file stands there, or nothing: else it may be anything that must not be lost.
bool is_free_for_state(const std::string& path);

/// The head alone; the size of the file is checked, not its planes. Throws Failure(input) where the file is missing,
/// cut off or damaged, Failure(inconsistent) where its format is of another version. The memory
/// it takes is bounded by the size of the file.
StateHead read_state_head(const std::string& path);

/// All of it, every checksum and shape checked. Throws likewise.
SavedState read_state(const std::string& path);

}  // namespace varve
