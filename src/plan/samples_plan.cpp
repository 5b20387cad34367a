#include "plan/samples_plan.h"

#include <algorithm>

namespace varve {
namespace {

std::string how_resolved(const Parameters& parameters, bool known) {
  const bool weigh = parameters.recursive.sample_filter != SampleFilter::none;
  return weigh && known ? "reconstructed at the pixel centers from the true positions of all samples around"
                        : "the mean of the valid samples";
}

std::string each_text(const Parameters& parameters, const std::string& count) {
  if (parameters.accumulator == Accumulator::gather)
    return "all " + count +
           " samples of every frame are gathered, each at its true position, along vectors of samples of its number; "
           "the cost grows with them";
  if (parameters.accumulator == Accumulator::subpixel)
    return "all " + count +
           " samples of every frame go to the histories of the quarters they lie in, along the vectors of the first";
  return "each of " + count +
         " has a history of its own, and the pixel is the mean of what comes of them; the cost grows with them";
}

}  // namespace

std::vector<PlannedPass> samples_passes(const SequenceInfo& info, const Parameters& parameters,
                                        std::vector<std::string>& notes) {
  if (info.first.sample_jitter.empty()) return {};
  const ColorOutput& output = info.first.outputs.front();
  const bool known = info.first.jitter.has_value();
  const std::string count = std::to_string(output.inputs.size());
  if (info.first.grid > 1)
    notes.push_back(
        "samples: each lies in the middle of its pixel of the files, moved by the jitter of these where that "
        "is known");
  else
    notes.push_back(known ? "samples: their positions are known"
                          : "samples: their positions are not known; give them with --jitter FILE, columns "
                            "frame,sample,jx,jy, or --jitter PATTERN:COUNT");
  if (output.inputs.size() == 1) return {{"samples", false, "there is one in each pixel"}};
  if (output.after) return {{"samples", true, each_text(parameters, count)}};
  return {{"samples", true,
           count + " in each pixel become one first: color is " + how_resolved(parameters, known) +
               ", vectors and depth are those of the sample with the longest vector; what follows costs no more than "
               "for one"}};
}

}  // namespace varve
