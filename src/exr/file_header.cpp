#include "exr/file_header.h"

#include "base/error.h"
#include "exr/container.h"

namespace varve {

const Attribute* Part::attribute(std::string_view attribute_name) const {
  for (const Attribute& a : attributes)
    if (a.name == attribute_name) return &a;
  return nullptr;
}

std::optional<int> Part::channel(std::string_view channel_name) const {
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (channels[i].name == channel_name) return int(i);
  return std::nullopt;
}

FileHeader read_header(const std::string& path, const ReadLimits& limits) {
  return open_container(InputBytes(path), limits).header;
}

bool has_every_chunk(const std::string& path) {
  try {
    const Container container = open_container(InputBytes(path), {});
    for (std::size_t part = 0; part < container.raw.size(); ++part) read_chunk_table(container, int(part));
    return true;
  } catch (const Failure&) {
    return false;
  }
}

const char* name_of(Compression compression) {
  constexpr const char* names[] = {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
  return names[int(compression)];
}

const char* name_of(Storage storage) {
  constexpr const char* names[] = {"scanline", "tiled", "deep scanline", "deep tiled"};
  return names[int(storage)];
}

const char* name_of(PixelType type) {
  constexpr const char* names[] = {"uint", "half", "float"};
  return names[int(type)];
}

bool is_lossy(Compression compression) { return compression >= Compression::pxr24; }

bool is_deep(const Part& part) { return part.storage == Storage::deep_scanline || part.storage == Storage::deep_tiled; }

}  // namespace varve
