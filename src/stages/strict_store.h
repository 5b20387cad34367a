// What the future says of the frames of a block, kept until the past arrives: in memory, or in a file on request.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "resolve/two_sided.h"

namespace varve {

class StrictStore {
 public:
  /// Keeps everything in memory; with a folder, in one file there. That file has no name: it is gone when the process
  /// is, however it ends.
  explicit StrictStore(const std::string& folder = "");
  ~StrictStore();
  StrictStore(StrictStore&&) noexcept;
  StrictStore& operator=(StrictStore&&) noexcept;

  /// Throws Failure(output) when the file cannot be written.
  void put(std::size_t index, std::vector<StrictSide> sides);
  bool has(std::size_t index) const;
  /// Gives back what was put, and forgets it. Throws Failure(output) when the file cannot be read.
  std::vector<StrictSide> take(std::size_t index);
  /// Forgets everything; the space of the file is used again.
  void clear();

 private:
  struct File;
  std::unique_ptr<File> file_;
  std::map<std::size_t, std::vector<StrictSide>> kept_;
};

}  // namespace varve
