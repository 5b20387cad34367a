// Which layer is in front, told by the depth of one frame.
#pragma once

#include <string>

#include "plan/resolve_job.h"

namespace varve {

/// A job with its layers named front to back, and the sentence that says how they were ordered; "" where nothing was.
struct OrderedLayers {
  ResolveJob job;
  std::string note;
};

/// With LayerOrder::depth: by the median depth of what each layer covers in the first frame on disk, so that every part
/// of a sequence is resolved in the same order; what is equal, and what covers nothing, stays as listed, the latter at
/// the back. Throws Failure(inconsistent) when a layer has no depth, and what reading throws.
OrderedLayers order_layers(const ResolveJob& job);

}  // namespace varve
