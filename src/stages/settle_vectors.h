// Vectors against pixels before a resolve: what they mean where nothing tells it, and a stop where what is told is
// wrong.
#pragma once

#include <functional>
#include <string>

#include "plan/resolve_job.h"

namespace varve {

/// A job whose vectors are told, and the sentence that says by what; "" where it was told already.
struct SettledVectors {
  ResolveJob job;
  std::string note;
};

/// With --convention auto, where vectors are there and neither names nor attributes tell what they mean, the pixels of
/// a few pairs of frames on disk decide, if they leave no doubt. All frames on disk count, so that every part of a
/// sequence is resolved alike. Throws Failure(inconsistent) with what the pixels say where they leave one.
SettledVectors settle_vectors(const ResolveJob& job);

/// Looks along the vectors of one or two pairs of the frames, and where they lead to strangers more often than no
/// motion would, finds out what they mean: throws Failure(inconsistent) naming it if the pixels leave no doubt that the
/// vectors are read wrongly, else warns. Cheap where the vectors are right.
void check_vectors(const ResolveJob& job, const SequenceInfo& info,
                   const std::function<void(const std::string&)>& warning, Workers& workers);

}  // namespace varve
