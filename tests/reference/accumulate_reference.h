// The slow twin of the recursive accumulator: one pixel at a time, in double, straight from the equations.
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "motion/motion.h"
#include "reference/rectify_reference.h"
#include "resolve/accumulate.h"

namespace varve::reference {

struct Pixel {
  Color color{};
  double total = 0, spread = 0, clip = 0, weight = 0;
  unsigned reject = 0;
};

/// A history that nothing has rounded, for soaks: read in place of the floats of a History, which lends its window and
/// what the tests compare with.
struct ExactHistory {
  Plane<glm::dvec4> color;
  Plane<double> total, spread;
};

/// What accumulate() must give at (x, y), display coordinates.
Pixel accumulate_pixel(const Present& present, const History& previous, const RecursiveParameters& recursive,
                       const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, unsigned restart_bit, int x,
                       int y, const ExactHistory* exact = nullptr);

/// The history at (x, y) before the present is blended in: rectified; `fetched` is what it was before that,
/// `trust` how much of it the tests believe.
Pixel rectified_history(const Present& present, const History& previous, const RecursiveParameters& recursive,
                        const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, unsigned restart_bit, int x,
                        int y, Color& fetched, double& trust, const ExactHistory* exact = nullptr);

/// The present at a pixel centre and the weight of its sample, 0 where it is not valid.
Color weighed_present(const Present& present, SampleFilter filter, std::optional<glm::dvec2> jitter, int x, int y,
                      double& weight);

/// What predict() must give; total 0 where there is no history.
Pixel predict_pixel(const Present& present, const History& previous, const RecursiveParameters& recursive,
                    const RectifyParameters& rectify, int x, int y);

/// The vector a pixel follows, by looking at all nine; with `surfaces_apart` surfaces come before background.
glm::vec2 dilated_motion(const Plane<glm::vec2>& motion, const Plane<float>& depth, Dilation dilation, int x, int y,
                         bool surfaces_apart = false);

}  // namespace varve::reference
