// A folder for the files that a target reads and writes.
#pragma once

#include <filesystem>

namespace varve::fuzz {

/// In memory where there is such a place; gone with the process.
const std::filesystem::path& scratch();

}  // namespace varve::fuzz
