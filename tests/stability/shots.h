// Frames at the extremes, as a file could hold them, and what the reader makes of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "motion/motion.h"
#include "resolve/present.h"

namespace varve::stability {

/// f(x, y) for every pixel of the window.
template <class F>
void each_pixel(const Window& w, const F& f) {
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) f(x, y);
}

/// One frame before anything was looked at: any bits. Vectors in pixels, y down; empty planes are not there.
struct RawFrame {
  Plane<glm::vec4> color;
  Plane<glm::vec2> backward, forward;
  Plane<float> depth;
  Plane<std::uint32_t> id;
  Plane<glm::vec3> normal;
  Plane<float> reactive, responsive;
  glm::dvec2 jitter{0};
  const Window& window() const { return color.window(); }
};
using RawShot = std::vector<RawFrame>;

RawShot clone(const RawShot& shot);

/// What a pass is given: colors and companions sanitized, vectors decoded, depth canonical.
/// The companions are a third of the color and the rest, and a plane of four values that stand alone.
Present present_of(const RawFrame& frame, Workers& workers, bool companions = false);
/// With the forward vectors in the place of the backward ones.
Present turned_present(const RawFrame& frame, Workers& workers);

/// What vectors a base shot has.
enum class Moves { rest, pan, any };

/// Two-tone noise with highlights, ids, depths, normals and masks; `frames` of it.
RawShot base_shot(const Window& window, Moves moves, int frames = 3, unsigned seed = 1, bool masks = false);

/// A kind of hostile input.
struct Extreme {
  std::string name;
  std::function<RawShot(const Window&)> make;
};
std::vector<Extreme> extremes();

/// Windows of every awkward size; `wide` adds the 16384 pixels.
std::vector<Window> awkward_windows(bool wide);

/// All 65536 half floats as one picture of 256x256, in each channel in another order; three frames.
RawShot all_halves();

/// The shot in a mirror: left and right, or top and bottom, places and vectors and jitter and normals.
RawShot mirrored(const RawShot& shot, bool vertical);
/// Light times a factor, alpha as it is.
RawShot scaled(const RawShot& shot, float factor);
/// One color everywhere, the rest as it is.
RawShot constant(const RawShot& shot, const glm::vec4& color);

}  // namespace varve::stability
