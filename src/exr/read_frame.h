// Pixels of chosen channels of one file, exactly as stored.
#pragma once

#include <span>
#include <vector>

#include "base/parallel.h"
#include "exr/file_header.h"

namespace varve {

/// planes[part][channel]; channels that were not asked for are empty.
struct FramePixels {
  std::vector<std::vector<RawPlane>> planes;
  const RawPlane& operator[](ChannelRef ref) const { return planes[std::size_t(ref.part)][std::size_t(ref.channel)]; }
};

/// Decodes the chosen channels of one file (ChannelRef::file is not looked at), chunks in parallel. Uncompressed, ZIP
/// and ZIPS scan lines are decoded here with libdeflate; every other flat part goes through the OpenEXR C++ API. Tiled
/// parts give their full-resolution level. Deep parts cannot be chosen. Bytes are the stored ones, NaN payloads
/// included. Throws Failure(input) naming the file, the part and where it broke (truncated, corrupt chunk), and
/// Failure(inconsistent) if the file on disk no longer has the header given.
FramePixels read_channels(const FileHeader& header, std::span<const ChannelRef> channels, Workers& workers);

}  // namespace varve
