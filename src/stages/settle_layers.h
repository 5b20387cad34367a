// What has to be known of layers before the headers of all frames are read.
#pragma once

#include <string>

#include "plan/resolve_job.h"

namespace varve {

/// A job with its layers named front to back, and with both modes where their difference is to be shown; and the
/// sentence that says how the layers were ordered, "" where they stand as listed.
struct SettledLayers {
  ResolveJob job;
  std::string note;
};

/// With LayerOrder::depth: by the median depth of what each layer covers in the first frame on disk, so that every part
/// of a sequence is resolved in the same order; what is equal, and what covers nothing, stays as listed, the latter at
/// the back. Throws Failure(inconsistent) when a layer has no depth, and what reading throws.
SettledLayers settle_layers(const ResolveJob& job);

}  // namespace varve
