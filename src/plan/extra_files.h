// Which files belong to a frame, where * stands for anything; and what a list of renders says of them.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exr/jitter.h"

namespace varve {

/// Paths of the files on disk that match any of the patterns, by frame, sorted and each once. `*` in the name of a
/// file (not of a folder) stands for any characters. Throws Failure(usage) for a pattern without a frame number while
/// there are several frames.
std::map<int, std::vector<std::string>> find_extra_files(const std::vector<std::string>& patterns,
                                                         const std::vector<int>& frames);

/// What a list of renders says of a file.
struct ListedExtra {
  std::array<int, 4> window{};  ///< x0 y0 x1 y1 from the corner of the display window, y down, half open
  std::optional<Jitter> jitter;
};

/// By the name of the file without folders. Throws Failure(input) when the list cannot be read or is none.
std::map<std::string, ListedExtra> read_extra_list(const std::string& path);

}  // namespace varve
