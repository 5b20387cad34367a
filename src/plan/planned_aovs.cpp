// The diagnostic planes that are asked for, and whether the accumulator can fill them.
#include "base/error.h"
#include "plan/plan.h"

namespace varve {
namespace {

unsigned filled_by(Accumulator accumulator) {
  switch (accumulator) {
    case Accumulator::recursive:
      return kByRecursive;
    case Accumulator::two_sided:
      return kByTwoSided;
    case Accumulator::gather:
      return kByGather;
    case Accumulator::subpixel:
      return kBySubpixel;
  }
  return 0;
}

}  // namespace

std::vector<const Aov*> planned_aovs(const OutputRequest& request, Accumulator accumulator) {
  const auto can_fill = [&](const Aov& aov) { return (aov.filled_by & filled_by(accumulator)) != 0; };
  std::vector<const Aov*> planned;
  for (const std::string& name : request.aovs) {
    if (name == "all") {
      planned.clear();
      for (const Aov& aov : diagnostic_aovs())
        if (can_fill(aov) && !aov.only_by_name) planned.push_back(&aov);
      return planned;
    }
    const Aov* aov = find_aov(name);
    if (!aov)
      throw Failure(ExitCode::usage,
                    "--aov " + name + ": there is no such diagnostic plane; varve help aovs lists them");
    if (!can_fill(*aov))
      throw Failure(ExitCode::usage, "--aov " + name +
                                         " has nothing to show with this --accumulator; leave the plane out, or give " +
                                         accumulators_of(*aov));
    planned.push_back(aov);
  }
  return planned;
}

}  // namespace varve
