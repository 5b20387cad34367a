// A folder for the files that a target reads and writes.
#pragma once

#include <filesystem>

namespace varve::fuzz {

/// Below the folder that VARVE_FUZZ_FOLDER names, or in memory where there is such a place; gone with the process,
/// unless it crashes.
const std::filesystem::path& scratch();

}  // namespace varve::fuzz
