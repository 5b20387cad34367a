// A file from nothing: parts, channels and attributes that no source lends.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "exr/write_frame.h"

namespace varve {

/// A part as it is to be. Data and display window need not agree; a file of several parts needs their names.
struct NewPart {
  std::string name;
  Window data_window, display_window;
  Compression compression = Compression::zip;
  std::vector<OutputChannel> channels;  ///< any order
  std::vector<Attribute> attributes;    ///< string (text), int, float, v2f and m44f (numbers, row major); names unique
};

/// Writes `path` as write_frame does: complete or not at all, the same bytes for any number of workers.
/// Throws Failure(output) with path, reason and remedy.
void write_new_file(const std::string& path, std::span<const NewPart> parts, int zip_level, Workers& workers);

/// Attributes ready for NewPart.
Attribute string_attribute(const std::string& name, const std::string& text);
Attribute number_attribute(const std::string& name, const std::string& type, std::vector<double> numbers);

}  // namespace varve
