// Layers that may hold motion vectors, whatever their convention: what is tested against the pixels.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "exr/channel_names.h"
#include "exr/file_header.h"

namespace varve {

/// Two to four channels of one layer.
struct VectorLayer {
  std::string name;                  ///< layer path as text; "" for bare names
  bool by_name = false;              ///< the names look like motion; else it is just a layer of floats
  std::vector<ChannelRef> channels;  ///< x before y, u before v, r before g before b
  std::vector<std::string> names;    ///< of the channels, as the user sees them
};

/// Layers for a subject: those whose names look like motion and that belong to it, or to no other layer; where there
/// are none, every layer of two to four float channels that is no color, depth, normal, position, id or texture
/// coordinate. Same view as the subject.
std::vector<VectorLayer> vector_layers(std::span<const FileHeader> files, const Subject& subject);

}  // namespace varve
