// The two-sided accumulator over a sequence, in blocks that are aligned to absolute frame numbers.
//
// A block has as many frames as the look-ahead. What the frames after say of a block is summed from the end of the
// block after it, back to the block's first frame; what the frames before say, from the first frame of the block before
// it, onwards. So every frame reaches at least one look-ahead and less than two in both directions, never across
// restarts, and depends on nothing else: any part of the sequence resolves to the same bytes. Each frame is read three
// times and passed twice in each direction. Memory is what the future says of one block, or a file in its place.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stages/preflight.h"
#include "stages/side_run.h"
#include "stages/strict_store.h"

namespace varve {

class TwoSidedPass {
 public:
  /// `read` gives a frame of the schedule with its vectors as stored; `stop` says that the work is no longer wanted.
  TwoSidedPass(const std::vector<ScheduledFrame>& schedule, const FrameReach& reach, const StepOptions& options,
               const std::string& spill_folder, std::function<SourceFrame(std::size_t)> read,
               std::function<bool()> stop, Workers& workers);

  /// Resolves a frame, in ascending order; `source` is that frame as read, and gets the motion to the frame before.
  /// Nothing when asked to stop. Throws what `read` throws.
  std::optional<std::vector<Accumulated>> resolve(std::size_t index, SourceFrame& source);

 private:
  /// A way through the past: started at `begin`, and done with all frames before `next`.
  struct Past {
    std::size_t begin, next;
    SideRun run;
  };
  bool start_block(std::size_t index);
  bool walk_back(std::size_t last);
  bool advance_to(std::size_t index);
  bool is_wanted(std::size_t index) const { return schedule_[index].write && !schedule_[index].complete; }

  const std::vector<ScheduledFrame>& schedule_;
  FrameReach reach_;
  StepOptions options_;
  std::function<SourceFrame(std::size_t)> read_;
  std::function<bool()> stop_;
  Workers& workers_;
  StrictStore futures_;
  std::map<std::size_t, std::vector<MotionRepair>> forward_repairs_;  ///< counts of the block's wanted frames
  std::size_t begin_ = 0, end_ = 0;                                   ///< of the block at hand: places in the schedule
  std::optional<Past> past_;                                          ///< for the block at hand
  std::optional<Past> next_past_;  ///< for the block after it, where that has another one
};

}  // namespace varve
