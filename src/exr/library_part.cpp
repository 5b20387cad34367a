#include "exr/library_part.h"

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include <algorithm>
#include <cctype>
#include <exception>

#include "base/error.h"
#include "base/foreign_code.h"
#include "base/printable.h"
#include "exr/container.h"
#include "exr/library_slice.h"

namespace varve {

Imf::PixelType library_type(PixelType type) {
  switch (type) {
    case PixelType::uint32:
      return Imf::UINT;
    case PixelType::float16:
      return Imf::HALF;
    default:
      return Imf::FLOAT;
  }
}

Imf::Slice library_slice(const RawPlane& plane) {
  const std::ptrdiff_t x_stride = std::ptrdiff_t(bytes_per_pixel(plane.type)), y_stride = plane.storage.stride();
  // Pixels are addressed from (0, 0) of the display window; that base may lie outside the plane.
  const std::ptrdiff_t back = std::ptrdiff_t(plane.window.x0 / plane.x_sampling) * x_stride +
                              std::ptrdiff_t(plane.window.y0 / plane.y_sampling) * y_stride;
  char* origin = reinterpret_cast<char*>(const_cast<std::byte*>(plane.row(0)));
  char* base = reinterpret_cast<char*>(reinterpret_cast<std::intptr_t>(origin) - back);
  return Imf::Slice(library_type(plane.type), base, std::size_t(x_stride), std::size_t(y_stride), plane.x_sampling,
                    plane.y_sampling);
}

std::string library_reason(const char* what) {
  // "... image file "x". Reason" -> "Reason"; the path is in our own sentence already.
  std::string text = what;
  const std::size_t quote = text.rfind("\". ");
  if (quote != std::string::npos) text.erase(0, quote + 3);
  while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower.find("error") == std::string::npos && text.size() < 200 ? text : std::string();
}

void read_part_by_library(const FileHeader& header, int part, std::vector<RawPlane>& planes, int threads) {
  const Part& wanted = header.parts[std::size_t(part)];
  // The library checks what it reads, but its releases keep on fixing bytes that ended it.
  const InForeignCode decoding(printable(part_in_words(header, part)) + " is damaged in its " +
                               name_of(wanted.compression) +
                               " pixels, so that the OpenEXR library broke down over them; render or copy it again");
  try {
    Imf::setGlobalThreadCount(library_threads(threads));
    Imf::MultiPartInputFile file(header.path.c_str(), library_threads(threads));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < planes.size(); ++c)
      if (!planes[c].empty()) frame.insert(wanted.channels[c].name, library_slice(planes[c]));
    if (wanted.storage == Storage::tiled) {
      Imf::TiledInputPart tiles(file, part);
      tiles.setFrameBuffer(frame);
      tiles.readTiles(0, tiles.numXTiles(0) - 1, 0, tiles.numYTiles(0) - 1, 0, 0);
    } else {
      Imf::InputPart lines(file, part);
      lines.setFrameBuffer(frame);
      lines.readPixels(wanted.data_window.y0, wanted.data_window.y1 - 1);
    }
  } catch (const Failure&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& caught) {
    const std::string reason = library_reason(caught.what());
    throw Failure(ExitCode::input, part_in_words(header, part) + " is damaged or cut off in its " +
                                       name_of(wanted.compression) + " pixels" +
                                       (reason.empty() ? "" : " (" + reason + ")") + "; render or copy it again");
  }
}

}  // namespace varve
