// Why a pixel did not use its history. Plain enumeration: kernels include it.
#pragma once

namespace varve {

/// One bit each, summed in the diagnostic plane `reject`.
enum RejectBit : unsigned {
  kRejectFirstFrame = 1,     ///< first frame of the sequence
  kRejectCut = 2,            ///< restart on a cut or a gap
  kRejectWindow = 4,         ///< previous position outside the data window
  kRejectDepth = 8,          ///< previous surface at another depth
  kRejectVector = 16,        ///< vector not finite or too long
  kRejectEmptyHistory = 32,  ///< no valid history there
  kRejectPresent = 64,       ///< the present itself is not finite; history is kept, or a fill from neighbors
};

}  // namespace varve
