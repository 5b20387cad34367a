#include "stages/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "stages/bitmap_font.h"

namespace varve {
namespace {

constexpr float kCell = 2;  ///< edge of a glyph's cell in drawing units: letters are 10 high
constexpr float kDash = 4;

std::string number(float value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.1f", double(value));
  return text.data();
}

std::string hex(const Ink& ink) {
  std::array<char, 8> text;
  const auto byte = [](float v) { return unsigned(std::lround(255 * std::clamp(v, 0.f, 1.f))); };
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(ink.r), byte(ink.g), byte(ink.b));
  return text.data();
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char ch : text) out += ch == '&' ? std::string("&amp;") : ch == '<' ? std::string("&lt;") : std::string(1, ch);
  return out;
}

glm::vec3 linear(const Ink& ink) {
  glm::vec3 out;
  for (int k = 0; k < 3; ++k)
    out[k] = ink[k] <= 0.04045f ? ink[k] / 12.92f : std::pow((ink[k] + 0.055f) / 1.055f, 2.4f);
  return out;
}

/// Pixels under construction.
struct Canvas {
  Plane<glm::vec4> pixels;
  float scale;

  /// Blends ink over the box around two corners; coverage(center of a pixel in drawing units) is 0..1.
  template <class Coverage>
  void blend(glm::vec2 low, glm::vec2 high, const Ink& ink, const Coverage& coverage) {
    const Window w = pixels.window();
    const glm::vec4 color(linear(ink), 1.f);
    for (int y = std::max(w.y0, int(low.y * scale) - 1); y < std::min(w.y1, int(high.y * scale) + 2); ++y)
      for (int x = std::max(w.x0, int(low.x * scale) - 1); x < std::min(w.x1, int(high.x * scale) + 2); ++x) {
        const float part = std::clamp(coverage((glm::vec2(x, y) + 0.5f) / scale), 0.f, 1.f);
        pixels.at(x, y) = pixels.at(x, y) * (1 - part) + color * part;
      }
  }
};

void draw(Canvas& canvas, const Drawing::Line& line) {
  const glm::vec2 way = line.to - line.from;
  const float length = std::max(glm::length(way), 1e-6f);
  const glm::vec2 along = way / length;
  const glm::vec2 margin(line.width);
  canvas.blend(glm::min(line.from, line.to) - margin, glm::max(line.from, line.to) + margin, line.ink,
               [&](glm::vec2 p) {
                 const glm::vec2 d = p - line.from;
                 const float at = glm::dot(d, along), off = std::abs(d.x * along.y - d.y * along.x);
                 if (at < -0.5f || at > length + 0.5f || (line.dashed && std::fmod(at, 2 * kDash) > kDash)) return 0.f;
                 return (0.5f * line.width - off) * canvas.scale + 0.5f;
               });
}

void draw(Canvas& canvas, const Drawing::Dot& dot) {
  canvas.blend(dot.center - dot.radius, dot.center + dot.radius, dot.ink,
               [&](glm::vec2 p) { return (dot.radius - glm::distance(p, dot.center)) * canvas.scale + 0.5f; });
}

void draw(Canvas& canvas, const Drawing::Text& text) {
  const float length = kCell * float(kGlyphAdvance * int(text.text.size()) - 1);
  const float shift = text.anchor == Anchor::start ? 0 : text.anchor == Anchor::middle ? 0.5f * length : length;
  for (std::size_t i = 0; i < text.text.size(); ++i)
    for (int y = 0; y < kGlyphHeight; ++y)
      for (int x = 0; x < kGlyphWidth; ++x) {
        if (!glyph_cell(text.text[i], x, y)) continue;
        const glm::vec2 cell(kCell * float(kGlyphAdvance * int(i) + x) - shift,
                             kCell * (float(y) - 0.5f * float(kGlyphHeight)));
        const glm::vec2 low = glm::round(text.upward ? text.at + glm::vec2(cell.y, -cell.x - kCell) : text.at + cell);
        canvas.blend(low, low + kCell, text.ink, [&](glm::vec2 p) {
          return p.x > low.x && p.y > low.y && p.x < low.x + kCell && p.y < low.y + kCell ? 1.f : 0.f;
        });
      }
}

std::string svg(const Drawing::Line& l) {
  return "<line x1='" + number(l.from.x) + "' y1='" + number(l.from.y) + "' x2='" + number(l.to.x) + "' y2='" +
         number(l.to.y) + "' stroke='" + hex(l.ink) + "' stroke-width='" + number(l.width) + "'" +
         (l.dashed ? " stroke-dasharray='4'" : "") + "/>\n";
}

std::string svg(const Drawing::Dot& d) {
  return "<circle cx='" + number(d.center.x) + "' cy='" + number(d.center.y) + "' r='" + number(d.radius) + "' fill='" +
         hex(d.ink) + "'><title>" + escaped(d.title) + "</title></circle>\n";
}

std::string svg(const Drawing::Text& t) {
  constexpr std::array<const char*, 3> anchors = {"start", "middle", "end"};
  const std::string x = number(t.at.x), y = number(t.at.y);
  return "<text x='" + x + "' y='" + y + "' dominant-baseline='central' text-anchor='" +
         anchors[std::size_t(t.anchor)] + "' fill='" + hex(t.ink) + "'" +
         (t.upward ? " transform='rotate(-90 " + x + " " + y + ")'" : "") + ">" + escaped(t.text) + "</text>\n";
}

}  // namespace

std::string drawing_svg(const Drawing& d) {
  const std::string size = std::to_string(d.width) + "' height='" + std::to_string(d.height);
  std::string out = "<svg xmlns='http://www.w3.org/2000/svg' width='" + size + "' viewBox='0 0 " +
                    std::to_string(d.width) + " " + std::to_string(d.height) +
                    "' font-family='sans-serif' font-size='12'>\n<rect width='" + size + "' fill='#ffffff'/>\n";
  for (const Drawing::Line& line : d.lines) out += svg(line);
  for (const Drawing::Dot& dot : d.dots) out += svg(dot);
  for (const Drawing::Text& text : d.texts) out += svg(text);
  return out + "</svg>\n";
}

Plane<glm::vec4> drawing_pixels(const Drawing& d, int scale) {
  Canvas canvas{Plane<glm::vec4>(Window{0, 0, d.width * scale, d.height * scale}, 0, glm::vec4(1.f)), float(scale)};
  for (const Drawing::Line& line : d.lines) draw(canvas, line);
  for (const Drawing::Dot& dot : d.dots) draw(canvas, dot);
  for (const Drawing::Text& text : d.texts) draw(canvas, text);
  return std::move(canvas.pixels);
}

}  // namespace varve
