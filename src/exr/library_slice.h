// Our planes as the OpenEXR C++ API wants them. Only for files that include that API.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfPixelType.h>

#include "base/raw_plane.h"

namespace varve {

Imf::PixelType library_type(PixelType type);
/// Threads as the library counts them: none of its own where ours alone is to work, which saves a handing over for each
/// chunk.
inline int library_threads(int threads) { return threads > 1 ? threads : 0; }

/// The library reads and writes through one kind of slice, so a plane that is only read loses its const here.
Imf::Slice library_slice(const RawPlane& plane);

}  // namespace varve
