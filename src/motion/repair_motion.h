// Vectors that the pixels refute are replaced, surface by surface, from a frame and its neighbor alone.
#pragma once

#include <array>
#include <vector>

#include "motion/validate_motion.h"

namespace varve {

/// off: vectors are believed; check: they are tested and nothing is changed; on: wrong ones are replaced.
enum class RepairMotion { off, check, on };

struct RepairParameters {
  RepairMotion mode = RepairMotion::off;
  double misfit_limit = 3;        ///< how many times the misfit of the frame's good vectors makes a cell suspicious
  double share = 0.25;            ///< of a surface's testable pixels that must be suspicious before anything is done
  double gain = 0.6;              ///< of the misfit that must remain at most with the motion found
  int reach = 64;                 ///< px, farthest motion that is searched for, besides the way of a whole object
  double depth_tolerance = 0.15;  ///< relative difference up to which two depths may be one surface
};

/// How a vector came to be what it is.
enum class RepairedBy : std::uint8_t { kept, neighbor, camera, search, dropped };

/// Vectors of one surface: what the file says, and what its pixels do.
struct SurfaceVectors {
  std::uint32_t label = 0;  ///< its id where the files have ids; else a name that holds in this frame only
  std::size_t pixels = 0, tested = 0, suspicious = 0;
  std::size_t zero = 0;            ///< pixels whose vector is zero
  std::size_t unusable = 0;        ///< pixels whose vector is NaN
  std::size_t lost = 0;            ///< pixels inside of the surface whose vector leads where it is not
  bool wrong = false;              ///< suspicious as a whole and explained by another motion, or lost
  glm::dvec2 stored{0}, found{0};  ///< mean vectors, pixels; `found` only where another motion was found
  double apart = 0;                ///< mean distance between them, pixels; 0 where none was found
};

struct MotionRepair {
  Plane<float> residual;                 ///< MotionValidity::residual of the vectors as they came
  Plane<std::uint8_t> how;               ///< RepairedBy; under check what would be done
  MotionCensus census;                   ///< of the vectors as they came
  std::array<std::size_t, 5> count{};    ///< pixels by RepairedBy
  std::vector<SurfaceVectors> surfaces;  ///< every surface, by label; without ids only those with 64 pixels and more
};

/// Tests the vectors `motion` from `here` to `there` and, under RepairMotion::on, replaces wrong ones: an unusable
/// vector by that of the nearest pixel of the same surface within 8 px; a surface whose vectors its pixels refute as a
/// whole by the `camera`'s motion where that explains it (may be empty), else by what find_shifts() and fit_shifts()
/// say; the rest of it is dropped (NaN). Nothing but the two frames has a say. `back`: the vectors there that lead
/// here; may be empty. All planes of a frame have one window; `motion` has that of `here`.
MotionRepair repair_motion(Plane<glm::vec2>& motion, const SeenFrame& here, const SeenFrame& there,
                           const Plane<glm::vec2>& back, const Plane<glm::vec2>& camera,
                           const RepairParameters& parameters, Workers& workers);

}  // namespace varve
