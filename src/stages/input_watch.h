// The input files of a run: none may change between two looks at it, and what they held goes into the outputs.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "exr/file_print.h"
#include "plan/extra_samples.h"
#include "plan/probe.h"

namespace varve {

/// The files of one frame as they were when they were first looked at.
struct WatchedFrame {
  std::vector<FileIdentity> files;  ///< of the color, of each role, and of further samples
  std::uint64_t print = 0;          ///< of the contents of all of them
};

/// By frame; a few dozen bytes each.
struct InputWatch {
  const InputSequence& input;
  const ExtraSamples& extras;
  std::map<int, WatchedFrame> frames = {};
};

/// Print of a frame's files; they are looked at when it is first asked for. Throws Failure(input) where a file cannot
/// be read, or changes meanwhile.
std::uint64_t print_of(InputWatch& watch, int frame);

/// Throws Failure(input) where a file of the frame is not the one that was looked at first.
void check_unchanged(const InputWatch& watch, int frame);

/// The first file of the frame that is not what it was; none.
std::optional<std::string> changed_file(const InputWatch& watch, int frame);
[[noreturn]] void refuse_changed(const std::string& path, int frame);

/// Calls read() between two looks at the frame's files. Where they were written meanwhile, what was read may be a
/// mixture: it is read once more, unless this run has used the frame before. Throws Failure(input) where that does not
/// help, or what read() throws.
template <class Read>
auto read_unchanged(InputWatch& watch, int frame, Read read) {
  const bool used_before = watch.frames.contains(frame);
  for (bool again = !used_before;; again = false) {
    print_of(watch, frame);
    try {
      auto result = read();
      const std::optional<std::string> changed = changed_file(watch, frame);
      if (!changed) return result;
      if (!again) refuse_changed(*changed, frame);
    } catch (const Failure&) {
      // Half of a file may look damaged.
      if (!again || !changed_file(watch, frame)) throw;
    }
    watch.frames.erase(frame);
  }
}

/// An input frame that an output was made from.
struct UsedFrame {
  int frame = 0;
  std::uint64_t print = 0;
  bool operator==(const UsedFrame&) const = default;
};

}  // namespace varve
