// The slow twins of the wide history filters, of un-jittering and of sharpening: from the equations, in double.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/plane.h"
#include "resolve/present.h"

namespace varve::reference {

/// A channel of `color` at a position in pixel centers, through the cubic of Mitchell and Netravali. With `dering` held
/// between the pixels whose weight is positive on both axes.
double cubic_at(const Plane<glm::vec4>& color, double b, double c, double x, double y, int channel, bool dering);

/// Of every channel, coefficients of the B-spline through all pixels: a linear system for each row, then each column.
Plane<glm::dvec4> solve_bspline(const Plane<glm::vec4>& color, int degree);

/// The spline at a position, by the recursion of de Boor; with `dering` held between the four nearest pixels.
double bspline_at(const Plane<glm::dvec4>& coefficients, const Plane<glm::vec4>& color, int degree, double x, double y,
                  int channel, bool dering);

/// The present between its samples at minus the jitter: every valid sample weighs by a tent of one pixel.
glm::dvec4 unjittered(const Present& present, glm::dvec2 jitter, int x, int y);

/// One pixel, sharpened.
glm::dvec4 sharpened(const Plane<glm::vec4>& color, const Plane<float>& total, double strength, int x, int y);

}  // namespace varve::reference
