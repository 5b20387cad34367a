// Pictures of one frame inside a page.
#pragma once

#include <string>

#include "base/parallel.h"
#include "plan/compare_job.h"

namespace varve {

/// PNG pictures as data: addresses.
struct PagePictures {
  int frame = 0;
  Window frame_window, region;  ///< all that is compared, and the worst of it
  std::string a, b, heat;       ///< of the region, one picture pixel for one pixel
  std::string whole_heat;       ///< of the frame, reduced to 480 pixels at most
};

/// Reads the frame again; pictures of its first color. `scratch` is a file name to write through. Throws
/// Failure(output) without the picture module.
PagePictures page_pictures(const CompareJob& job, int frame, const std::string& scratch, Workers& workers);

/// Bytes as base64 (RFC 4648).
std::string base64(const std::string& bytes);

}  // namespace varve
