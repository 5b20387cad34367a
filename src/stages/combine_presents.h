// Several subjects that become one color, before the frames are accumulated.
#pragma once

#include <vector>

#include "plan/probe.h"
#include "resolve/choices.h"
#include "resolve/present.h"

namespace varve {

struct CombineOptions {
  const RoleRequest& roles;
  bool show = false;                                ///< fill Present::combined
  SampleFilter sample_filter = SampleFilter::none;  ///< by which samples of known positions become one
};

/// The data window of the part that the output is written to.
const Window& window_of(const FrameHeaders& headers, const ColorOutput& output);

/// For each of accumulated_subjects(): whether it is one subject, and not several combined.
std::vector<bool> are_single_subjects(const FrameHeaders& headers);

/// `read`: a present for each of headers.subjects, vectors as stored. Gives one for each of accumulated_subjects():
/// outputs of one subject as they are, those that are made before composited or resolved from their inputs, and for
/// those that are made after their inputs, ready to be accumulated apart.
std::vector<Present> combine_presents(const FrameHeaders& headers, std::vector<Present> read,
                                      const CombineOptions& options, Workers& workers);

}  // namespace varve
