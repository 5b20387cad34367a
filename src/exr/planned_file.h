// What every writer of a file shares: parts as planned, with their headers as bytes, put into one file in order.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "exr/container.h"
#include "exr/write_chunks.h"
#include "exr/write_frame.h"

namespace varve {

/// One part on its way out: its header as bytes, and its pixels where it is not copied.
struct PlannedPart {
  Part part;
  RawPart raw;
  std::vector<const RawPlane*> planes;  ///< in the order of part.channels; empty: chunks are copied
};

/// Channels by name, each with its plane, which must hold the part's whole data window. Throws Failure(output).
void take_channels(std::vector<OutputChannel> channels, const std::string& path, PlannedPart& plan);
/// The part's channels and compression as scan lines, in its header.
void set_scanlines(PlannedPart& plan);
/// What a part needs in a file with others, and how many chunks follow.
void set_part_type(PlannedPart& plan, bool multi_part);

/// Compresses and appends the planes of a part; returns where its chunks lie.
std::vector<std::uint64_t> encode_part(const PlannedPart& plan, int zip_level, const ChunkTarget& target,
                                       Workers& workers);

/// Writes headers and parts; the file appears only when complete. `write_part(i, target)` appends the chunks of part i
/// and returns where they lie. `check`, if any, is called before the file gets its name. Throws Failure(output), and
/// what `check` throws.
void write_planned(const std::string& path, std::vector<PlannedPart>& parts,
                   const std::function<std::vector<std::uint64_t>(std::size_t, const ChunkTarget&)>& write_part,
                   const std::function<void()>& check = {});

}  // namespace varve
