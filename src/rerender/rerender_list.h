// The list of what to render again: rectangles of frames, with the place of every sample and the file it is to go to.
#pragma once

#include <string>
#include <vector>

#include "rerender/fill_positions.h"
#include "rerender/rectangles.h"

namespace varve {

struct RerenderEntry {
  int frame = 0, rectangle = 0;       ///< counts within the frame
  RenderRectangle what;               ///< its window in pixels of the frame
  std::vector<glm::dvec2> positions;  ///< of each sample: position minus pixel center, pixels, y down
  std::vector<std::string> files;     ///< one for each sample
};

struct RerenderList {
  RerenderRequest request;
  Window display;  ///< display window; windows of the list count from its corner
  std::vector<RerenderEntry> entries;
  std::size_t pixels = 0, frames = 0;  ///< of the frames that were looked at
  double samples = 0;                  ///< asked for, in all
  double variance = 0, gain = 0;       ///< expected in all pixels, and what of it is taken away
};

/// Shares the budget among the tiles of all frames, merges them and places their samples. A budget holds after merging.
RerenderList make_rerender_list(std::vector<TileFrame> frames, const Window& display, const RerenderRequest& request,
                                const FramePositions& known);

/// The whole file: `varve help rerender` describes both.
std::string rerender_json(const RerenderList& list, const std::string& version);
std::string rerender_csv(const RerenderList& list);

}  // namespace varve
