// How a renderer writes motion vectors, and the affine decoder behind every row of the table.
#pragma once

#include <span>
#include <string_view>

namespace varve {

enum class MotionUnit { pixel, unit, ndc };  ///< px; fraction of the display window; -1..1 across it
enum class MotionDirection { previous, next };

/// decoded = sign * ((v - bias) * scale) / shutter, converted to pixels, y down.
/// `previous`: decoded is B (previous = current + B); `next`: decoded is F (next = current + F).
struct MotionEncoding {
  double bias = 0, scale = 1, shutter = 1;
  double sign_x = 1, sign_y = 1;  ///< -1 turns the stored axis round
  MotionUnit unit = MotionUnit::pixel;
  MotionDirection direction = MotionDirection::previous;
};

/// How far a row of the table can be trusted (research grades: measured, documented, unverified).
enum class Evidence { measured, documented, unverified };

struct MotionConvention {
  std::string_view name;
  std::string_view layers;  ///< last element of the layer names it is found under, comma separated, any case;
                            ///< "" for any layer. A channel with a dot ("forward.u") brings its own layer.
  std::string_view backward_x, backward_y;  ///< channel that holds the vector to the previous frame; "" if none
  std::string_view forward_x, forward_y;    ///< channel that holds the vector to the next frame; "" if none
  MotionEncoding backward, forward;
  double background_depth;  ///< depth from this value on is background; the rule for 0 is common to all rows
  Evidence evidence;
  std::string_view note;
};

/// Every convention that `--convention` takes besides `auto` and `none`, in the order of `varve help conventions`.
std::span<const MotionConvention> motion_conventions();
const MotionConvention* find_motion_convention(std::string_view name);

}  // namespace varve
