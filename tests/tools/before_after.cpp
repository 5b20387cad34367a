// varve_before_after OUT.png SCALE WIDTHxHEIGHT X,Y[ X,Y...] LABEL=IMAGE.exr...
// Crops of several images side by side, magnified without filtering, one row per crop and a label over each column.

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/plane.h"
#include "exr/pictures.h"
#include "read_rgb.h"
#include "stages/bitmap_font.h"

namespace {

constexpr int kGap = 6, kLetter = 3, kLabel = 7 * kLetter;  // output pixels; a letter is 3x5 cells
constexpr glm::vec4 kPaper(0.01f, 0.01f, 0.01f, 1.f), kInk(0.9f, 0.9f, 0.9f, 1.f);

void draw_label(varve::Plane<glm::vec4>& picture, int x0, const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (int y = 0; y < 5 * kLetter; ++y)
      for (int x = 0; x < 3 * kLetter; ++x)
        if (varve::glyph_cell(text[i], x / kLetter, y / kLetter)) {
          const int px = x0 + int(i) * 4 * kLetter + x;
          if (picture.window().contains(px, y + kLetter)) picture.at(px, y + kLetter) = kInk;
        }
  }
}

struct Crop {
  int x = 0, y = 0, width = 0, height = 0, scale = 1;
};

void draw_crop(varve::Plane<glm::vec4>& picture, int x0, int y0, const varve::tools::Rgb& image, const Crop& crop) {
  const Imath::Box2i& window = image.window;
  const std::size_t columns = std::size_t(window.max.x - window.min.x + 1);
  for (int y = 0; y < crop.height * crop.scale; ++y)
    for (int x = 0; x < crop.width * crop.scale; ++x) {
      const Imath::V2i from(crop.x + x / crop.scale, crop.y + y / crop.scale);
      if (!window.intersects(from)) continue;
      const std::size_t i = std::size_t(from.y - window.min.y) * columns + std::size_t(from.x - window.min.x);
      picture.at(x0 + x, y0 + y) = {image.planes[0][i], image.planes[1][i], image.planes[2][i], 1.f};
    }
}

void run(const std::vector<std::string>& words) {
  if (words.size() < 5)
    throw std::runtime_error("usage: varve_before_after OUT.png SCALE WIDTHxHEIGHT X,Y[ X,Y...] LABEL=IMAGE.exr...");
  Crop shape;
  shape.scale = std::stoi(words[1]);
  if (std::sscanf(words[2].c_str(), "%dx%d", &shape.width, &shape.height) != 2) throw std::runtime_error("bad size");
  std::vector<Crop> crops;
  std::vector<std::pair<std::string, varve::tools::Rgb>> images;
  for (std::size_t i = 3; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    if (equals != std::string::npos) {
      images.emplace_back(words[i].substr(0, equals), varve::tools::read_rgb(words[i].substr(equals + 1), "auto"));
      continue;
    }
    crops.push_back(shape);
    if (std::sscanf(words[i].c_str(), "%d,%d", &crops.back().x, &crops.back().y) != 2)
      throw std::runtime_error("bad crop");
  }
  const int width = shape.width * shape.scale, height = shape.height * shape.scale;
  const varve::Window window{0, 0, int(images.size()) * (width + kGap) - kGap,
                             kLabel + int(crops.size()) * (height + kGap) - kGap};
  varve::Plane<glm::vec4> picture(window, 0, kPaper);
  for (std::size_t column = 0; column < images.size(); ++column) {
    const int x0 = int(column) * (width + kGap);
    draw_label(picture, x0 + kLetter, images[column].first);
    for (std::size_t row = 0; row < crops.size(); ++row)
      draw_crop(picture, x0, kLabel + int(row) * (height + kGap), images[column].second, crops[row]);
  }
  varve::write_color_png(words[0], picture, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(std::vector<std::string>(argv + 1, argv + argc));
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "varve_before_after: %s\n", e.what());
    return 2;
  }
}
