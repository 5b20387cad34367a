// PNG pictures of a frame: the resolved color of each subject, and each diagnostic plane through its color map.
#pragma once

#include <string>
#include <vector>

#include "exr/color_space.h"
#include "stages/write_resolved.h"

namespace varve {

/// Writes FOLDER/<name>.<frame, 4 digits>.png for `color` and every component of `aovs`; with several subjects the name
/// has layer and view in front. `display` may be null: sRGB. Throws Failure(output).
void write_previews(const std::string& folder, int frame, const std::vector<ResolvedSubject>& subjects,
                    const std::vector<const Aov*>& aovs, const DisplayTransform* display, Workers& workers);

}  // namespace varve
