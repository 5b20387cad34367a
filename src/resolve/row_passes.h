// What stands between the steps of the row kernel: plain functions of one row, compiled once for every processor.
#pragma once

#include <cstdint>

#include "resolve/accumulate.h"
#include "resolve/accumulate_row.h"

namespace varve {

/// Planes of the bounds on the weight of the present; windows are those of the present.
struct BoundPlanes {
  Plane<float> residual;  ///< of history against present; empty without that bound
  Plane<float>* blur;     ///< gets the variance of the kernel that made each pixel, px^2
};

/// One frame as the row passes see it. `y` and `x` below are relative to the corner of the present's window, as in
/// AccumulateView.
struct RowPassView {
  const AccumulateView& frame;
  const Present& present;
  const History& previous;
  const RecursiveParameters& parameters;
  bool tests_surfaces, tests_vectors;   // with the planes that this takes
  bool weighs;                          // the weight of the present differs from pixel to pixel
  bool finishes;                        // something is done to what was blended
  const BoundPlanes* bounds = nullptr;  // what blur and residual have to say; null: nothing
};

/// Rows of `frame.width` pixels that the passes hand on to each other.
struct RowPassScratch {
  float* trust;            // in [0, 1]: how much of the history is believed, 1 where nothing speaks against it
  float* steadiness;       // in [0, 1]: factor on alpha near a clip event
  double* present_weight;  // for the blend
};

/// Which passes a frame needs. `frame` must hold the history already.
RowPassView row_passes_for(const AccumulateView& frame, const Present& present, const History& previous,
                           const RecursiveParameters& parameters);

/// True when the depth test is not left to the kernel: it has no slope, and drops history that may still be wanted.
bool tests_depth_apart(const RecursiveParameters& parameters);

/// After the fetch: compares what the history knows of its surface and its motion with the present. Writes the trust of
/// every pixel; where it is none and the rule is not OnReject::weight the history is dropped (total 0). Bits are noted.
/// Reads: depth of the 4 neighbors, the 4 history pixels around the previous position.
void test_history(const RowPassView& pass, int y, const RowScratch& scratch, const RowPassScratch& extra);

/// Which of the four history pixels around the previous position make the history of a pixel, bit i + 2 j, after the
/// tests; 15 when they left it as fetched.
unsigned standing_taps(const RowPassView& pass, int x, int y);

/// After the tests, before the rectification: how near the history is to a clip event (Falcor's anti-flicker).
/// Reads the 3x3 neighborhood of the present.
void find_clip_events(const RowPassView& pass, int y, const RowScratch& scratch, const RowPassScratch& extra);

/// After the rectification: the weight of the present in each pixel; ages the history by its trust.
void weigh_present(const RowPassView& pass, int y, const RowScratch& scratch, const RowPassScratch& extra);

/// After the blend: means of logarithms, and blurred presents where history was not believed.
void finish_row(const RowPassView& pass, int y, const RowScratch& scratch, const RowPassScratch& extra);

/// Adds the set bits of a row to one count each.
void count_bits(const std::uint32_t* reject, int width, std::array<std::size_t, kRejectBits>& counts);

/// The 3x3 mean of the present with weights 1 2 1, valid pixels only. x and y relative to the window.
glm::dvec4 soft_present(const Present& present, int x, int y);

}  // namespace varve
