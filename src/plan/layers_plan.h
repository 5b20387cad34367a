// What the plan says of layers that make one color.
#pragma once

#include <optional>
#include <string>

#include "plan/plan.h"

namespace varve {

/// The pass that puts layers together, as it stands in the plan before the frames are accumulated, or after.
PlannedPass layers_pass(const SequenceInfo& info);
/// True when layers are resolved apart and put together afterwards.
bool composites_after(const SequenceInfo& info);

/// Throws Failure(usage) for what cannot go with layers, naming the remedy.
void check_layers(const SequenceInfo& info, const Parameters& parameters);

/// The choices about layers as text, for the parameters of an output; empty where no layers are put together.
std::string layers_text(const LayersRequest& request, const SequenceInfo& info);

}  // namespace varve
