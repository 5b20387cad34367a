#include "motion/convention.h"

namespace varve {
namespace {

using enum MotionDirection;
using enum MotionUnit;

// Farther than anything a scene holds in any unit; Cycles writes exactly this where nothing is hit. Depth 0 and below
// (distance kind), infinity and NaN are background in every row.
constexpr double kFar = 1e10;

// A pixel vector whose y axis points up, as most renderers have it.
constexpr MotionEncoding pixels_up(MotionDirection direction) { return {0, 1, 1, 1, -1, pixel, direction}; }

// 0.5 + d / (2 max): the "normalized" form with `max` pixels at 0 and at 1.
constexpr MotionEncoding centered_up(double max, MotionDirection direction) {
  return {0.5, 2 * max, 1, 1, -1, pixel, direction};
}

constexpr MotionEncoding kNone{};

// Sources: the project's research table of conventions, which grades every entry. A row is graded by its weakest part.
constexpr MotionConvention kConventions[] = {
    {"cycles",
     "vector",
     "X",
     "Y",
     "Z",
     "W",
     pixels_up(previous),
     {0, 1, 1, -1, 1, pixel, next},
     kFar,
     Evidence::measured,
     "Blender's Vector pass: pixels, y up; X,Y lead to the previous frame, Z,W are the negated way to the next. All "
     "zero when the render had motion blur on. Animated zoom and lens shift are not in it."},
    {"cycles-fileout", "velocity,vector,motion", "X", "Y", "", "", pixels_up(previous), kNone, kFar, Evidence::measured,
     "Vector pass through Blender's File Output node: as cycles, but W is lost, so only the way to the previous frame "
     "is used."},
    {"nuke", "forward,backward", "backward.u", "backward.v", "forward.u", "forward.v", pixels_up(previous),
     pixels_up(next), kFar, Evidence::measured,
     "Layers forward and backward, channels u and v: pixels, y up. Forward measured on sample files, where depth 0 is "
     "background and an open shutter scales the vectors; the sign of backward is documented only."},
    {"varve",
     "velocity,motion",
     "x",
     "y",
     "forward.x",
     "forward.y",
     {0, 1, 1, 1, 1, pixel, previous},
     {0, 1, 1, 1, 1, pixel, next},
     kFar,
     Evidence::measured,
     "This program's own: pixels, y down, previous position minus this one, without the jitter; layer forward, next "
     "position minus this one. Files of `varve synth` say so in the attribute varve:motion."},
    {"vray", "velocity", "", "", "R", "G", kNone, centered_up(1, next), kFar, Evidence::unverified,
     "Velocity element, 0.5 is rest, current to next (documented); the scale is twice the maximum velocity (1 by "
     "default) and the y axis is not verified. The element's clamp must be off."},
    {"arnold", "motionvector", "", "", "R", "G", kNone, pixels_up(next), kFar, Evidence::unverified,
     "Pixels, scaled by the shutter length (documented): give the shutter. Direction and y axis are not verified."},
    {"rsmb", "velocity,motionvector,motionvectors,mv,vector,motion", "", "", "R", "G", kNone, centered_up(1, next),
     kFar, Evidence::unverified,
     "Normalized vectors, 0.5 is rest, y up (documented): give a scale of twice the maximum displacement. To previous "
     "or "
     "to next is the exporter's choice; next is assumed."},
    {"maya", "velocity,motionvector,mv2n,vector,motion", "", "", "R", "G", kNone, centered_up(256, next), kFar,
     Evidence::unverified,
     "Normalized vectors with Maya's maximum displacement of 256 pixels (documented); y axis and direction are not "
     "verified."},
    {"c4d", "velocity,motionvector,motion,vector", "", "", "R", "G", kNone, centered_up(1, next), kFar,
     Evidence::unverified, "Cinema 4D's Motion Vector pass is said to be rsmb's form: give the scale."},
    {"renderman",
     "forward,backward",
     "backward.R",
     "backward.G",
     "forward.R",
     "forward.G",
     {0, 1, 1, 1, 1, pixel, previous},
     {0, 1, 1, 1, 1, pixel, next},
     kFar,
     Evidence::unverified,
     "Raster-space vectors to both sides (names and space read in source); axes, sign and shutter are not verified."},
    {"redshift", "motionvectors,motionvector,mv", "", "", "R", "G", kNone, pixels_up(next), kFar, Evidence::unverified,
     "Raw pixels in R and G; direction, axes and remapping by Max Motion are not verified."},
    {"moonray",
     "motionvec",
     "",
     "",
     "R",
     "G",
     kNone,
     {0, 1, 1, 1, -1, ndc, next},
     kFar,
     Evidence::unverified,
     "Screen space from -1 to 1 per frame (documented), premultiplied by alpha, so edges are short; y axis and "
     "direction "
     "are not verified."},
    {"unity",
     "motionvectors,motionvector,motion",
     "R",
     "G",
     "",
     "",
     {0, 1, 1, -1, 1, unit, previous},
     kNone,
     kFar,
     Evidence::unverified,
     "Fraction of the image, clamped to 0.5 by the recorder (said by its staff); this position minus the previous one "
     "and y up are not verified."},
    {"unreal",
     "velocity,motionvectors,motionvector",
     "R",
     "G",
     "",
     "",
     {0.5, 2, 1, -1, 1, unit, previous},
     kNone,
     kFar,
     Evidence::unverified,
     "0.5 is rest, normalized to the image; range, direction and axes are not verified."},
    {"fusion", "vector,backvector", "BackVector.X", "BackVector.Y", "Vector.X", "Vector.Y", pixels_up(previous),
     pixels_up(next), kFar, Evidence::unverified,
     "Pixels, x right; Vector leads to the next frame, BackVector to the previous (documented); y up is not verified."},
    {"max", "", "", "", "velX", "velY", kNone, pixels_up(next), kFar, Evidence::unverified,
     "Channels velX and velY (documented); unit, direction and y axis are not verified."},
};

}  // namespace

std::span<const MotionConvention> motion_conventions() { return kConventions; }

const MotionConvention* find_motion_convention(std::string_view name) {
  for (const MotionConvention& row : kConventions)
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace varve
