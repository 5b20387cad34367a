// The camera of each frame: from the standard attributes, from the JSON in Cycles' Note, or from a sidecar.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exr/file_header.h"
#include "motion/camera.h"

namespace varve {

/// A line of a sidecar, as it stands there. OpenGL's conventions: column vectors, camera looking along -z with y up,
/// clip space from -1 to 1, y up. Row major.
struct CameraRow {
  std::array<double, 16> view{};                     ///< world to camera
  std::optional<std::array<double, 16>> projection;  ///< camera to clip space
  double focal = 0, aperture = 0;                    ///< without a projection: focal length and width of the film, both
                                                     ///< in one unit
};

/// What `--camera` names: `auto` (the headers), `off`, or a file.
struct CameraSource {
  enum class Kind { automatic, none, table } kind = Kind::automatic;
  std::map<int, CameraRow> table;
  std::string description;  ///< for probe and logs
};

/// Throws Failure(usage) for an unknown word, Failure(input) with path and line for a bad file.
CameraSource parse_camera_source(const std::string& text);

/// What one part says of its camera.
struct FoundCamera {
  std::optional<Camera> camera;
  std::string source;   ///< "worldToCamera and worldToNDC", "Note", ...; empty: nothing is there
  std::string problem;  ///< why what is there is of no use, or what was assumed; may stand beside a camera
};

/// `automatic` prefers the standard attributes to the Note. Matrices that cannot be a camera are left out with their
/// problem told; those of a sidecar throw Failure(inconsistent) naming the frame.
FoundCamera find_camera(const CameraSource& source, const Part& part, int frame);

/// The cameras of one frame, one for each subject.
struct FrameCameras {
  std::vector<std::optional<Camera>> cameras;
  std::vector<std::optional<glm::dvec2>> jitter;
};
using CameraTrack = std::map<int, FrameCameras>;  ///< by frame

}  // namespace varve
