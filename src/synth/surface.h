// One analytic surface: its outline, paint, and motion, and how a renderer would describe that motion.
#pragma once

#include <functional>
#include <string>

#include "synth/camera.h"
#include "synth/texture.h"

namespace varve::synth {

/// Flat outlines lie in the local plane z = 0. `bars` is a rectangle cut into upright wires. `sky` is all directions,
/// infinitely far away; only the rotation of its place counts.
enum class Outline { rectangle, disc, bars, sphere, sky };

/// Bending within the surface's own plane: material (m, v) lies at (m + offset(v, time), v).
struct Sway {
  double amplitude = 0;  ///< units
  double wave = 0;       ///< radians per unit of v
  double speed = 0;      ///< radians per frame
  bool rooted = false;   ///< the lower end (v = half_height) rests
};

/// A highlight: a mirror of one lamp at infinity, on bumps if there are any.
struct Shine {
  double strength = 0;  ///< peak, scene-linear; 0: none
  double power = 200;
  double bump = 0;       ///< slope of the bumps
  double bump_size = 5;  ///< units between bumps
};

/// What the vectors of a surface follow. All but `own` are wrong on purpose.
enum class Vectors {
  own,      ///< the surface itself: exact
  carrier,  ///< Surface::carrier, the world where that is empty; sway is not seen either
  none,     ///< zero, whatever moves
  below,    ///< vectors and depth are those of the surface behind this one
  lensless  ///< right but for zoom and lens shift, which Cycles leaves out
};

/// Front to back, for layered output.
enum class Layer { foreground, middle, background };

struct Surface {
  std::string name;
  Outline outline = Outline::rectangle;
  double half_width = 10, half_height = 10;  ///< units; disc and sphere: half_width is the radius
  double bar_pitch = 4, bar_width = 0.3;     ///< units; widths of the wires vary by a quarter around bar_width
  Texture texture;
  Motion motion;
  Sway sway;
  Shine shine;
  double opacity = 1;
  bool stochastic = false;                        ///< a sample sees the surface or not, by chance; opacity is the share
  bool lit = false;                               ///< darker where it faces away from the lamp
  std::function<double(double time)> brightness;  ///< factor on the paint; empty: 1
  Vectors vectors = Vectors::own;
  Motion carrier;
  Layer layer = Layer::background;
  unsigned id = 0;  ///< of the object, from 1; given by the scene table
};

}  // namespace varve::synth
