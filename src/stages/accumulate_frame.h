// One frame through the accumulator: every present of it meets what is known of other frames.
#pragma once

#include <utility>
#include <vector>

#include "stages/combine_resolved.h"
#include "stages/follow_motion.h"
#include "stages/gather_frame.h"
#include "stages/two_sided_pass.h"
#include "subpixel/accumulate_subpixel.h"

namespace varve {

/// What one thing that is accumulated carries from frame to frame: the reader's part and the accumulator's.
struct SubjectState {
  ForwardMemory forward;
  History history;
  SubpixelHistory subpixel;            ///< of all samples of a pixel, with the first of them
  std::vector<GatherMemory> gathered;  ///< of each sample
};

struct AccumulatorOptions {
  const Parameters& parameters;
  const GatherParameters& gather;  ///< with what other parameters have to say in it
  const std::vector<const Aov*>& aovs;
  const std::optional<BlurTable>& blur_table;  ///< of the four histories
};

/// One for each of source.presents. The history is that of the frame before, and stays; it is dropped at a restart.
std::vector<Resolved> accumulate_recursive(const AccumulatorOptions& options, const SourceFrame& source,
                                           const ScheduledFrame& scheduled, std::vector<SubjectState>& states,
                                           Workers& workers);

/// The same by four histories. What samples of the same pixels make together is the result of the first of them, and
/// the others are empty. The histories in `states` go on to the next frame.
std::vector<Resolved> accumulate_subpixel_frame(const AccumulatorOptions& options, const SourceFrame& source,
                                                const ScheduledFrame& scheduled, std::vector<SubjectState>& states,
                                                Workers& workers);

/// Empty when asked to stop.
std::vector<Resolved> accumulate_two_sided(TwoSidedPass& pass, std::size_t index, SourceFrame& source);

/// From the frames between span.first and span.second, all held by the window. What samples of the same pixels make
/// together is the result of the first of them, and the others are empty.
std::vector<Resolved> accumulate_gather(const AccumulatorOptions& options, FrameWindow& window, std::size_t index,
                                        std::pair<std::size_t, std::size_t> span, std::vector<SubjectState>& states,
                                        Workers& workers);

}  // namespace varve
