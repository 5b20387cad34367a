// The frames around the one that is resolved: each read once, and forgotten when it is passed.
#pragma once

#include <cstddef>
#include <functional>
#include <map>

#include "stages/source_frame.h"

namespace varve {

/// Frames by their place in the schedule. Memory is bounded by the widest span held, never by the sequence.
class FrameWindow {
 public:
  /// `read` makes a frame from its place; it is called in ascending order as long as spans move forward.
  explicit FrameWindow(std::function<SourceFrame(std::size_t)> read) : read_(std::move(read)) {}

  /// Afterwards exactly the frames `first` to `last`, both included, are here. Throws what `read` throws.
  void hold(std::size_t first, std::size_t last) {
    std::erase_if(frames_, [&](const auto& entry) { return entry.first < first || entry.first > last; });
    for (std::size_t i = first; i <= last; ++i)
      if (!frames_.contains(i)) frames_.emplace(i, read_(i));
  }
  /// A frame that is held.
  const SourceFrame& operator[](std::size_t index) const { return frames_.at(index); }
  SourceFrame& operator[](std::size_t index) { return frames_.at(index); }

 private:
  std::function<SourceFrame(std::size_t)> read_;
  std::map<std::size_t, SourceFrame> frames_;
};

}  // namespace varve
