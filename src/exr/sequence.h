// Sequence patterns (shot.####.exr) and frame lists (1-10,20,30-50x2).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace varve {

/// A file name with a place for the frame number: `####`, `@@@@`, `%04d`, `$F4` (`#` alone is four digits, `@` one,
/// `%d` and `$F` unpadded). Negative numbers keep the width behind the sign ("-0007"). A name without a
/// placeholder is one file. Only the last placeholder of the file name counts; folders are taken as they are.
class SequencePattern {
 public:
  /// Throws Failure(usage) if the text is empty or the padding is beyond 16 digits.
  static SequencePattern parse(std::string_view text);

  bool has_frame() const { return has_frame_; }
  std::string path(int frame) const;
  const std::string& text() const { return text_; }
  /// Frame numbers of the files on disk that match, ascending. Longer numbers than the padding match too.
  /// A name without a placeholder is frame 1 if the file exists. A folder that cannot be read has no frames.
  std::vector<int> frames_on_disk() const;

 private:
  std::string text_, before_, after_;
  int digits_ = 0;
  bool has_frame_ = false;
};

/// Frame lists: single frames, ranges `a-b`, steps `a-bx2`, separated by commas; negative frames allowed
/// (`-10--5`, `-3-4`). Order is ascending, duplicates fall together.
/// Throws Failure(usage) naming the part that cannot be read; more than ten million frames are refused.
std::vector<int> parse_frame_list(std::string_view text);

/// Short list text that parse_frame_list turns into the same frames: "1-10,20,30-50x2"; "" for no frames.
std::string format_frame_list(const std::vector<int>& frames);

}  // namespace varve
