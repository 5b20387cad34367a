// From shifts between frames to the offset of each, and to what is wrong with the offsets that were stated.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace varve {

/// Measured between two frames of one shot, which are given by their places in a list.
struct ShiftBetween {
  std::size_t now = 0, before = 0;
  glm::dvec2 shift{0};  ///< offset of `now` minus that of `before`, pixels
  glm::dvec2 sigma{0};  ///< its standard errors
};

struct OffsetFit {
  std::vector<glm::dvec2> offsets;  ///< pixels, of mean 0, since only differences are seen; NaN where no shift leads
  double misfit = 0;                ///< pixels, rms over the shifts and both axes: how far they contradict each other
  std::size_t known = 0;            ///< frames with an offset
};

/// Weighted least squares over all shifts, with the weight of shifts that contradict the others lowered. Frames that no
/// chain of shifts connects with most others are left out.
OffsetFit fit_offsets(std::size_t frames, std::span<const ShiftBetween> shifts);

/// What stated offsets may have gone through before they met the renderer: truth = linear * stated(frame + later).
struct JitterMistake {
  double xx = 1, xy = 0, yx = 0, yy = 1;
  int later = 0;
  std::string sentence;  ///< "y is turned round"; empty: nothing is wrong

  bool none() const { return sentence.empty(); }
};

struct JitterVerdict {
  enum class Kind { fits, mistaken, at_rest, unexplained, cannot_tell } kind = Kind::cannot_tell;
  JitterMistake mistake;  ///< the best explanation, for fits, mistaken and unexplained
  double misfit = 0;      ///< pixels, rms, of it
  double as_stated = 0;   ///< pixels, rms, of the offsets as they are stated
  double runner_up = 0;   ///< pixels, rms, of the best explanation that says something else of these frames
};

/// Every mistake of the table against the measured shifts: scale 2 and 1/2, signs, swapped axes, one frame early or
/// late, and their combinations; and that the samples never moved. `stated` has an entry for each frame of the list.
/// Nothing is chosen where two explanations are about as good.
JitterVerdict judge_jitter(std::span<const std::optional<glm::dvec2>> stated, std::span<const ShiftBetween> shifts);

}  // namespace varve
