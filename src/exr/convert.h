// Between stored pixel types and float. F16C where the processor has it, the same bits without.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/raw_plane.h"

namespace varve {

/// `count` pixels of `type` to float. uint32 beyond 2^24 rounds to nearest.
void to_float(PixelType type, const std::byte* from, float* to, std::size_t count);

/// Float to half, rounded to nearest even. Finite values beyond +-65504 become +-65504; returns how many.
std::size_t to_half_clamped(const float* from, std::uint16_t* to, std::size_t count);

}  // namespace varve
