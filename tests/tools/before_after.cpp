// varve_before_after OUT.png SCALE WIDTHxHEIGHT X,Y[ X,Y...] LABEL=IMAGE.exr...
// Crops of several images side by side, magnified without filtering, one row per crop and a label over each column.

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/plane.h"
#include "exr/pictures.h"
#include "read_rgb.h"

namespace {

constexpr int kGap = 6, kLetter = 3, kLabel = 7 * kLetter;  // output pixels; a letter is 3x5 cells
constexpr glm::vec4 kPaper(0.01f, 0.01f, 0.01f, 1.f), kInk(0.9f, 0.9f, 0.9f, 1.f);

// One octal digit per row, top first; its bits are the cells, left first.
const std::map<char, int> kLetters = {
    {'A', 025755}, {'B', 065656}, {'C', 034443}, {'D', 065556}, {'E', 074647}, {'F', 074644}, {'G', 034553},
    {'H', 055755}, {'I', 072227}, {'J', 011152}, {'K', 055655}, {'L', 044447}, {'M', 057755}, {'N', 075555},
    {'O', 025552}, {'P', 065644}, {'Q', 025563}, {'R', 065655}, {'S', 034216}, {'T', 072222}, {'U', 055557},
    {'V', 055552}, {'W', 055775}, {'X', 055255}, {'Y', 055222}, {'Z', 071247}};

void draw_label(varve::Plane<glm::vec4>& picture, int x0, const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto letter = kLetters.find(char(std::toupper(static_cast<unsigned char>(text[i]))));
    if (letter == kLetters.end()) continue;
    for (int y = 0; y < 5 * kLetter; ++y)
      for (int x = 0; x < 3 * kLetter; ++x)
        if (letter->second >> (3 * (4 - y / kLetter) + 2 - x / kLetter) & 1) {
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
