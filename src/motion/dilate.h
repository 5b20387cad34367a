// Dilation where cameras moved the background.
#pragma once

#include "motion/motion.h"

namespace varve {

/// dilate_motion(), except that by `longest` surfaces (finite depth) come before background (infinite depth): a sky
/// that a turning camera carries may have the longest vectors of all, and every thing at rest before it would wear a
/// rim that moves with the sky. Background beside a surface follows the surface, as the antialiased rim does; other
/// background follows what is longest. A surface whose own vector is NaN and that has only background around keeps it.
/// By `nearest` surfaces come first anyway. Measured on the aquarium, whose rims lost 0.10 dB to the sky: they lose
/// nothing.
DilatedMotion dilate_surfaces_apart(Plane<glm::vec2> motion, const Plane<float>& depth, Dilation dilation,
                                    Workers& workers, SurfaceMarks marks = {});

/// Whether background has vectors that cameras made: then surfaces come first.
inline bool moves_background(CameraUse use) { return use == CameraUse::all || use == CameraUse::background; }

}  // namespace varve
