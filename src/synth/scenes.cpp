#include "synth/scenes.h"

#include <string>

#include "base/error.h"

namespace varve::synth {
namespace {

constexpr SceneRow kScenes[] = {
    {"quality-still",
     "Everything at once, at rest: bricks, zone plate, checker floor, sub-pixel wires, a thin rod, a ball with a "
     "glint; a "
     "light pulse and a sliding shadow.",
     quality_still},
    {"quality-cam", "The same seen by a camera that pans, dollies and rolls, 1 to 6 pixels a frame.", quality_camera},
    {"quality-obj",
     "The same with moving objects, 0.35 to 12 pixels a frame; two of them turn back in the middle, the rod spins.",
     quality_objects},
    {"quality-all", "The same with moving camera and moving objects.", quality_all},
    {"indoor-still",
     "A room of large smooth things with paint far finer than the pixels, at rest: aliased shading, few silhouettes.",
     indoor_still},
    {"indoor", "The same while camera, globe and carpet move, 1 to 4 pixels a frame: what Yang 2009 measured.",
     indoor_moving},
    {"still", "Detail down to a tenth of a pixel at rest: what a resolver can gain at best, and blur it adds.",
     still_scene},
    {"pan", "The same under a steady pan by fractions of pixels: blur by repeated resampling.", pan_scene},
    {"zoom", "The same while the focal length doubles every 40 frames: the footprint of history changes.", zoom_scene},
    {"zoom-lacking", "The same with vectors that know nothing of the zoom, as Cycles writes them.", zoom_lacking_scene},
    {"shift-lacking", "A moving camera whose lens slides by two pixels a frame, which the vectors lack likewise.",
     shift_lacking_scene},
    {"rotation", "The same detail under a roll of the camera: vectors that differ in every pixel, leaving at the rim.",
     rotation_scene},
    {"fence", "Wires of 0.1 to 0.4 pixels that drift: thin things that come and go, clipped away by small windows.",
     fence_scene},
    {"zone-plate", "Every frequency and direction, drifting: aliasing, and what of it a resolver takes for detail.",
     zone_plate_scene},
    {"crossing", "Occluders that cross at different speeds: disocclusion on both sides, vectors at rims.",
     crossing_scene},
    {"reversal", "Things that turn back at once and that swing: extrapolated motion, two-sided windows.",
     reversal_scene},
    {"teleport", "A thing that jumps in frames 13, 25 and 37 with right vectors of 160 pixels: long vectors, leaps.",
     teleport_scene},
    {"cut", "A hard cut between frames 24 and 25; the vectors of frame 25 lead to a frame that was never rendered.",
     cut_scene},
    {"sky", "A textured sky behind a turning camera, with right vectors on it.", sky_scene},
    {"sky-zero", "The same with zero vectors on the sky, as Cycles writes them: vectors wrong where depth is infinite.",
     sky_zero_scene},
    {"glints", "Bumps that mirror a lamp, peaks up to 60: highlights that sparkle and do not move with their surface.",
     glints_scene},
    {"pulse", "Lights that pulse, fade, and flash for one frame, and a lamp that moves: lag and ghosts of light.",
     pulse_scene},
    {"shadow", "Soft shadows that slide over resting walls and floor: change that no vector tells.", shadow_scene},
    {"stochastic-alpha", "Veils of opacity 1/4 that each sample meets by chance, at rest and moving.",
     stochastic_scene},
    {"panes", "Two glass panes that move against each other before bricks: several motions in one pixel, layers.",
     panes_scene},
    {"hdr", "Small lamps from 1 to 65504 in front of darkness: the end of half, fireflies that are true.", hdr_scene},
    {"vectors-cloth", "Wrong vectors: a banner ripples, its vectors are those of the pole it hangs from.", cloth_scene},
    {"vectors-vegetation", "Wrong vectors: blades sway and the camera moves, but the vectors of the blades are zero.",
     vegetation_scene},
    {"vectors-ocean", "Wrong vectors and depth: water moves, vectors and depth are those of the ground below it.",
     ocean_scene},
    {"vectors-matrix", "Wrong vectors: a propeller spins, but its previous matrix is missing; only the camera counts.",
     matrix_scene},
    {"vectors-skinned", "Wrong vectors in frames 13, 25 and 37 only: a walker jumps, its skin is blended as if not.",
     skinned_scene},
};

}  // namespace

std::span<const SceneRow> scene_table() { return kScenes; }

Scene make_scene(std::string_view name) {
  std::string names;
  for (const SceneRow& row : kScenes) {
    if (row.name == name) {
      Scene scene = row.build();
      scene.name = row.name;
      scene.provokes = row.provokes;
      return scene;
    }
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  throw Failure(ExitCode::usage, "there is no scene \"" + std::string(name) + "\"; the scenes are " + names);
}

}  // namespace varve::synth
