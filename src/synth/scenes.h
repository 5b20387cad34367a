// The table of scenes: each provokes one thing that breaks a resolver.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "synth/scene.h"

namespace varve::synth {

/// A row of the table.
struct SceneRow {
  std::string_view name;
  std::string_view provokes;  ///< a sentence
  Scene (*build)();           ///< without name and sentence
};

/// Every scene, in the order of `varve help scenes`.
std::span<const SceneRow> scene_table();

/// The scene of that name; throws Failure(usage) naming what there is.
Scene make_scene(std::string_view name);

// What the rows build.
Scene quality_still();
Scene quality_camera();
Scene quality_objects();
Scene quality_all();
Scene indoor_still();
Scene indoor_moving();
Scene still_scene();
Scene pan_scene();
Scene zoom_scene();
Scene zoom_lacking_scene();
Scene shift_lacking_scene();
Scene rotation_scene();
Scene fence_scene();
Scene zone_plate_scene();
Scene crossing_scene();
Scene reversal_scene();
Scene teleport_scene();
Scene cut_scene();
Scene sky_scene();
Scene sky_zero_scene();
Scene glints_scene();
Scene pulse_scene();
Scene shadow_scene();
Scene stochastic_scene();
Scene panes_scene();
Scene hdr_scene();
Scene cloth_scene();
Scene vegetation_scene();
Scene ocean_scene();
Scene matrix_scene();
Scene skinned_scene();

}  // namespace varve::synth
