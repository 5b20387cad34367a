// The picture module: the only place that knows OpenImageIO. No exception may leave it, its callers see C.
#include "exr/pictures_module.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

namespace {

// Threads belong to the program that loads the module.
constexpr int kThreads = 1;

void map_colors(const float* values, int count, const char* colormap, float* rgb) {
  const OIIO::ImageSpec spec(count, 1, 1, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf source(spec, const_cast<float*>(values));
  OIIO::ImageBuf colors;
  if (!OIIO::ImageBufAlgo::color_map(colors, source, 0, colormap, OIIO::ROI(), kThreads))
    throw std::runtime_error(colors.geterror());
  if (!colors.get_pixels(OIIO::ROI(0, count, 0, 1, 0, 1, 0, 3), OIIO::TypeDesc::FLOAT, rgb))
    throw std::runtime_error(colors.geterror());
}

/// The format is told by name, so that the file may be called anything while it is not complete.
void write_png(const char* path, const unsigned char* rgb, int width, int height) {
  const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  const auto file = OIIO::ImageOutput::create("png");
  if (!file) throw std::runtime_error("OpenImageIO has no PNG writer here");
  if (!file->open(path, spec) || !file->write_image(OIIO::TypeDesc::UINT8, rgb) || !file->close())
    throw std::runtime_error(file->geterror());
}

template <class Work>
int guarded(char* reason, std::size_t room, const Work& work) {
  const auto leave = [&](const char* text) {
    if (room == 0) return;
    const std::size_t length = std::min(std::strlen(text), room - 1);
    std::memcpy(reason, text, length);
    reason[length] = '\0';
  };
  try {
    work();
    return 0;
  } catch (const std::exception& failure) {
    leave(failure.what());
  } catch (...) {
    leave("OpenImageIO failed without a reason");
  }
  return 1;
}

}  // namespace

extern "C" {

[[gnu::visibility("default")]] int varve_color_map_v1_run(const float* values, int count, const char* colormap,
                                                          float* rgb, char* reason, std::size_t room) {
  return guarded(reason, room, [&] { map_colors(values, count, colormap, rgb); });
}

[[gnu::visibility("default")]] int varve_write_png_v1_run(const char* path, const unsigned char* rgb, int width,
                                                          int height, char* reason, std::size_t room) {
  return guarded(reason, room, [&] { write_png(path, rgb, width, height); });
}
}
