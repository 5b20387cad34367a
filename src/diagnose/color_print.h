// A number that tells whether two frames are the same to the last bit.
#pragma once

#include <cstdint>

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// Hash of the bits of all pixels and of the window, the same for any thread count; 0 where all pixels are the same,
/// since black frames and the like say nothing. Never 0 otherwise.
std::uint64_t color_print(const Plane<glm::vec4>& color, Workers& workers);

}  // namespace varve
