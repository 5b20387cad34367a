#include "stages/page_pictures.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "exr/pictures.h"
#include "stages/heat_maps.h"

namespace varve {
namespace {

constexpr int kRegionWidth = 240, kRegionHeight = 160;  ///< px; enlarged by the page
constexpr int kWholeWidth = 480;

template <class T>
Plane<T> cropped(const Plane<T>& plane, const Window& window) {
  Plane<T> out(window);
  for (int y = window.y0; y < window.y1; ++y) std::copy_n(&plane.at(window.x0, y), window.width(), out.row(y));
  return out;
}

/// The region around the block of 20 x 20 pixels in which the mean of the map is greatest.
Window worst_region(const Plane<float>& heat) {
  const Window& all = heat.window();
  // Of a small frame half, so that it is enlarged too.
  const auto side = [](int most, int whole) { return std::min(whole, std::clamp(whole / 2, 48, most)); };
  const int width = side(kRegionWidth, all.width()), height = side(kRegionHeight, all.height());
  const int step = 20;
  double most = -1;
  int best_x = all.x0, best_y = all.y0;
  for (int y = all.y0; y < all.y1; y += step)
    for (int x = all.x0; x < all.x1; x += step) {
      const Window block = intersect({x, y, x + step, y + step}, all);
      double sum = 0;
      for (int j = block.y0; j < block.y1; ++j)
        for (int i = block.x0; i < block.x1; ++i) sum += double(heat.at(i, j));
      if (sum / double(block.pixels()) > most) {
        most = sum / double(block.pixels());
        best_x = x + step / 2;
        best_y = y + step / 2;
      }
    }
  const int x0 = std::clamp(best_x - width / 2, all.x0, all.x1 - width);
  const int y0 = std::clamp(best_y - height / 2, all.y0, all.y1 - height);
  return {x0, y0, x0 + width, y0 + height};
}

/// Box means of n x n pixels, so that the picture is at most kWholeWidth wide.
Plane<float> reduced(const Plane<float>& map) {
  const Window& w = map.window();
  const int n = (w.width() + kWholeWidth - 1) / kWholeWidth;
  Plane<float> out(Window{0, 0, (w.width() + n - 1) / n, (w.height() + n - 1) / n});
  for (int y = 0; y < out.window().y1; ++y)
    for (int x = 0; x < out.window().x1; ++x) {
      const Window block = intersect({w.x0 + x * n, w.y0 + y * n, w.x0 + (x + 1) * n, w.y0 + (y + 1) * n}, w);
      double sum = 0;
      for (int j = block.y0; j < block.y1; ++j)
        for (int i = block.x0; i < block.x1; ++i) sum += double(map.at(i, j));
      out.at(x, y) = float(sum / double(block.pixels()));
    }
  return out;
}

std::string data_address(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  std::remove(path.c_str());
  return "data:image/png;base64," + base64(bytes.str());
}

std::string picture(const Plane<glm::vec4>& color, const std::string& scratch) {
  write_color_png(scratch, color, nullptr);
  return data_address(scratch);
}
std::string picture(const Plane<float>& map, const std::string& scratch) {
  write_map_png(scratch, map, "magma", 0, 1);
  return data_address(scratch);
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? std::uint32_t(static_cast<unsigned char>(bytes[i + k])) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? digits[(group >> (18 - 6 * k)) & 63] : '=';
  }
  return out;
}

PagePictures page_pictures(const CompareJob& job, int frame, const std::string& scratch, Workers& workers) {
  const FramePair pair = read_frame_pair(job, frame, false);
  if (pair.match.subjects.empty()) throw Failure(ExitCode::output, "there is no color to show");
  const PairPixels pixels = read_pixels(pair, workers);
  const ColorPair colors = color_pair(pair, pair.match.subjects.front(), pixels, job.nan_equal, workers);
  const Plane<float> heat = heat_map(colors, workers);
  PagePictures pictures;
  pictures.frame = frame;
  pictures.frame_window = colors.window();
  pictures.region = worst_region(heat);
  pictures.a = picture(cropped(colors.a, pictures.region), scratch);
  pictures.b = picture(cropped(colors.b, pictures.region), scratch);
  pictures.heat = picture(cropped(heat, pictures.region), scratch);
  pictures.whole_heat = picture(reduced(heat), scratch);
  return pictures;
}

}  // namespace varve
