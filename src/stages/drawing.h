// Lines, dots and words that become an SVG or pixels.
#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/plane.h"

namespace varve {

/// sRGB, 0..1.
using Ink = glm::vec3;

enum class Anchor { start, middle, end };

/// Positions in pixels from the upper left corner, y down. Drawn in the order lines, dots, words, over white.
struct Drawing {
  struct Line {
    glm::vec2 from, to;
    Ink ink;
    float width = 1;
    bool dashed = false;
  };
  struct Dot {
    glm::vec2 center;
    float radius = 4;
    Ink ink;
    std::string title;  ///< shown by a browser over the dot
  };
  struct Text {
    glm::vec2 at;  ///< of the middle of the line's height
    std::string text;
    Ink ink;
    Anchor anchor = Anchor::start;
    bool upward = false;  ///< turned by 90 degrees, read from below
  };
  int width = 0, height = 0;
  std::vector<Line> lines;
  std::vector<Dot> dots;
  std::vector<Text> texts;
};

std::string drawing_svg(const Drawing& drawing);

/// Scene-linear, opaque; each unit of the drawing is `scale` pixels.
Plane<glm::vec4> drawing_pixels(const Drawing& drawing, int scale);

}  // namespace varve
