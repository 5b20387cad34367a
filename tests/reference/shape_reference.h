// Shapes of colors as questions: is this color inside, and which one inside is nearest. Slow and obvious.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "resolve/choices.h"

namespace varve::reference {

using Color = std::array<double, 4>;

struct Sample {
  Color color{};
  double weight = 1;
};

struct Statistics {
  Color mean{}, deviation{}, low{}, high{};
  double noise = 0;
};

Statistics statistics(const std::vector<Sample>& samples);

/// Eigenvectors of the covariance, row by row, in long double by always turning the largest element away.
struct Axes {
  std::array<std::array<double, 3>, 3> direction{};
  std::array<double, 3> variance{};
};
Axes principal_axes(const std::vector<Sample>& samples);

struct Shape {
  std::function<bool(const Color&)> inside;
  std::function<Color(const Color&)> nearest;
  Color mean{}, center{};
};

/// Bounds for each component, alpha too.
Shape box_shape(Color low, Color high, const Color& mean);

/// 7-DOP, 13-DOP or the box along the principal axes, and an interval for alpha.
Shape slab_shape(const std::vector<Sample>& samples, const Statistics& statistics, Box box);

Shape ellipsoid_shape(const std::vector<Sample>& samples, const Statistics& statistics, double gamma);

/// Largest of the three color components.
double size_of(const Color& color);

}  // namespace varve::reference
