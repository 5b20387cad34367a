// One output file: parts and attributes of a source file, some channels replaced, some added.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "exr/file_header.h"

namespace varve {

/// A channel to be written; `pixels` must cover the part's data window in channel.type.
struct OutputChannel {
  Channel channel;
  const RawPlane* pixels = nullptr;
};

struct OutputPart {
  int source_part = 0;       ///< part of the source that lends attributes, windows, name and view
  bool copy_chunks = false;  ///< the part is written as it is, chunk by chunk, never decoded (flat, tiled or deep)
  std::vector<OutputChannel> channels;               ///< all channels of the part when !copy_chunks; any order
  std::optional<Compression> compression;            ///< default: the source's if lossless, else ZIP
  std::optional<std::pair<Window, Window>> windows;  ///< data and display, where they are not the source's
  std::optional<std::string> name;                   ///< of the part, where it is not the source's; empty: none
  std::vector<std::string> without;                  ///< attributes of the source that do not hold any more
};

struct WriteOptions {
  int zip_level = 1;  ///< 1..9, libdeflate's scale; 1 costs a third less to encode than 4 for files 2 % larger
  std::vector<std::pair<std::string, std::string>> attributes;  ///< strings set in the first part (provenance)
  std::function<void()> check = {};  ///< called when all is written, before the file gets its name; may throw
};

/// Writes `path` with every attribute of the source parts kept (standard, custom and opaque), parts in order.
/// The file appears under its name only when complete: written beside it under a temporary name, flushed, renamed;
/// the temporary is removed on failure. The same input gives the same bytes for any number of workers.
/// Parts without tiles stay scanline; a tiled or deep part whose channels are rewritten becomes flat scanline.
/// Throws Failure(output) with path, reason and remedy; Failure(input) if a source part cannot be copied.
void write_frame(const std::string& path, const FileHeader& source, std::span<const OutputPart> parts,
                 const WriteOptions& options, Workers& workers);

/// Folders above `path` exist and can be written to, and `path` is no folder; throws Failure(output) otherwise.
void check_writable(const std::string& path);

}  // namespace varve
