// Why a pixel did not use its history. Plain enumeration: kernels include it.
#pragma once

namespace varve {

/// One bit each, summed in the diagnostic plane `reject`.
enum RejectBit : unsigned {
  kRejectFirstFrame = 1,       ///< first frame of the sequence
  kRejectCut = 2,              ///< restart on a cut or a gap
  kRejectWindow = 4,           ///< previous position outside the data window
  kRejectDepth = 8,            ///< previous surface at another depth
  kRejectVector = 16,          ///< vector not finite or too long
  kRejectEmptyHistory = 32,    ///< no valid history there
  kRejectPresent = 64,         ///< the present itself is not finite; history is kept, or a fill from neighbors
  kRejectNormal = 128,         ///< previous surface turned otherwise
  kRejectId = 256,             ///< another id there
  kRejectSpeed = 512,          ///< its vector was longer or shorter
  kRejectDirection = 1024,     ///< its vector led elsewhere
  kRejectAcceleration = 2048,  ///< its vector was another, by the length of the difference
  kRejectReactive = 4096,      ///< the reactive mask takes half of the history or more
};

/// Number of bits above.
inline constexpr int kRejectBits = 13;

}  // namespace varve
