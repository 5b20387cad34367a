// What the colors of a frame lack, for the plane `evaluation` and for the list of what to render again.
#pragma once

#include <deque>
#include <vector>

#include "rerender/rerender_list.h"
#include "stages/source_frame.h"
#include "stages/write_resolved.h"

namespace varve {

/// Frame by frame, what a list of renders is made from: the first color that is written.
struct RerenderSurvey {
  std::vector<TileFrame> frames;
  FramePositions positions;  ///< where samples are already
  Window display;
};

/// One for each of `colors`, whose `lacking` points to it afterwards. Adds the frame to `survey` where a list is
/// wanted.
std::deque<Evaluation> evaluate_colors(const SourceFrame& source, std::vector<ResolvedSubject>& colors,
                                       const RerenderRequest& request, RerenderSurvey& survey, Workers& workers);

}  // namespace varve
