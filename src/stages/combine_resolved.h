// From what was accumulated to the colors that are written: as it is, or several put together.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "stages/combine_presents.h"
#include "stages/source_frame.h"
#include "stages/write_resolved.h"
#include "subpixel/accumulate_subpixel.h"

namespace varve {

/// One thing that was accumulated: the present met its history.
struct Resolved {
  Accumulated accumulated;
  History prediction = {};                             ///< only where the diagnostic plane of that name is asked for
  std::array<ShownQuarter, kQuadrants> quarters = {};  ///< only with --scale 2
};

/// The colors of a frame, ready to be written. What they point to belongs to the frame, to what was resolved, or to
/// `made`.
struct ResolvedColors {
  struct Made {
    Present present;
    Resolved resolved;
  };
  std::deque<Made> made;
  std::deque<Plane<glm::vec4>> finished;
  std::deque<Plane<float>> differences;
  std::vector<ResolvedSubject> colors;
};

/// What came of each layer that was accumulated apart, held to what a layer can be: see hold_resolved().
void hold_layers(const SourceFrame& source, std::vector<Resolved>& resolved, Workers& workers);

/// `resolved`: one for each of source.presents. Outputs whose inputs were accumulated apart are made here; their inputs
/// are written too where ColorOutput::write_inputs says so. ResolvedSubject::finished stays empty.
ResolvedColors combine_resolved(const SourceFrame& source, const std::vector<Resolved>& resolved,
                                const CombineOptions& options, Workers& workers);

}  // namespace varve
