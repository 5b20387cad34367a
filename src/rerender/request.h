// What is wanted of every pixel, and what a list of further renders may cost.
#pragma once

#include <string>
#include <vector>

namespace varve {

struct RerenderRequest {
  double want_samples = 16;  ///< effective samples that a pixel is to have; 0: any number will do
  double want_noise = 0;     ///< standard deviation of a pixel over the light around it; 0: any will do
  int tile = 32;             ///< edge, pixels
  int most = 16;             ///< samples that a tile may get in one frame
  double budget = 0;         ///< samples for each pixel of the frames written, on average; 0: all that are lacking
  int overhead = 4096;       ///< what starting a render costs, in samples: rectangles are merged to save it
  std::vector<std::string> files;  ///< .json or .csv; empty: no list is wanted
};

}  // namespace varve
