// A picture of n x n times the pixels, seen as n x n samples in each pixel.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "exr/channel_names.h"
#include "exr/jitter_pattern.h"
#include "exr/read_frame.h"

namespace varve {

/// The header of one sample of each pixel: windows n times smaller, all else as it is. Throws Failure(inconsistent)
/// with the remedy when a window is not made of whole blocks of n x n pixels counted from 0, or a part has no pixel of
/// its own at every place: deep parts, subsampled channels.
FileHeader header_of_cell(const FileHeader& stored, int n);

/// The same parts for all n x n cells, row by row: part p of cell c is part c * parts + p.
FileHeader header_of_cells(const FileHeader& cell, int n);

/// Subjects of one cell's header for all cells: those of the first, then those of the second, and so on. Vectors that
/// count pixels are to be divided by n. `parts` counts those of one cell in each file.
std::vector<Subject> subjects_of_cells(std::span<const Subject> subjects, std::span<const int> parts, int n);

/// Where in its pixel the sample of a cell lies, from its place in the pixel of the file: (cell + 0.5 + jitter) / n -
/// 0.5 on each axis. Without a jitter it is in the middle.
Jitter jitter_of_cell(const std::optional<Jitter>& stored, int cell, int n);

/// Reads channels that refer to header_of_cells(); each channel of the file is read once.
FramePixels read_cells(const FileHeader& stored, const FileHeader& cells, std::span<const ChannelRef> channels, int n,
                       Workers& workers);

}  // namespace varve
