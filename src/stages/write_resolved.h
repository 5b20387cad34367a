// From resolved planes back to the channels of a file: stored types, diagnostics beside the color.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <vector>

#include "diagnose/aov.h"
#include "exr/channel_names.h"
#include "exr/color_space.h"
#include "exr/read_frame.h"
#include "exr/write_frame.h"
#include "motion/repair_motion.h"
#include "resolve/accumulate.h"
#include "subpixel/accumulate_subpixel.h"

namespace varve {

/// One subject, resolved.
struct ResolvedSubject {
  const Subject* subject = nullptr;
  const Present* present = nullptr;
  const Accumulated* accumulated = nullptr;
  const History* prediction = nullptr;          ///< only where the plane `prediction` is asked for
  const Plane<glm::vec4>* finished = nullptr;   ///< what is written, where that is not what the history keeps
  const Plane<float>* difference = nullptr;     ///< to what the other --layers mode gives; only where it is asked for
  const MotionRepair* repair = nullptr;         ///< what was said of the vectors; null or without planes: nothing
  const Plane<float>* lacking = nullptr;        ///< samples; only where the plane `evaluation` is asked for
  std::span<const ShownQuarter> quarters = {};  ///< of every pixel; empty without --scale 2
  const ShownQuarter* shown_quarter = nullptr;  ///< the one that is written in place of the pixel; null: the pixel is

  const Plane<glm::vec4>& color() const {
    if (shown_quarter) return shown_quarter->color;
    return finished && !finished->empty() ? *finished : accumulated->history.color;
  }
  const Plane<glm::vec4>& companion(std::size_t i) const {
    return shown_quarter ? shown_quarter->companions[i] : accumulated->history.companions[i];
  }
};

/// Parts ready for write_frame, and the planes they point to.
struct FileOutput {
  std::vector<OutputPart> parts;
  std::deque<RawPlane> planes;
  std::size_t half_overflows = 0;  ///< finite values beyond +-65504 that had to be held there
};

/// Channel of a diagnostic plane: "varve.count", with the layer where several are resolved and the view where it is not
/// the default one: "varve.fg.count", "varve.left.motion.x".
std::string aov_channel(const Aov& aov, const Subject& subject, bool several_layers, std::string_view component);

/// The source's parts with the resolved color and its companions in place. With `keep`, other channels stand beside
/// them and parts without any are copied; without, only resolved channels are written. `aovs` are added to each
/// subject's part. `passed_on` says what of the source is used up.
FileOutput resolved_parts(const FileHeader& source, const FramePixels& pixels,
                          const std::vector<ResolvedSubject>& subjects, const std::vector<const Aov*>& aovs, bool keep,
                          const PassedOn& passed_on, const ColorConversion* out_of_working_space, Workers& workers);

/// Only the diagnostic planes, in the parts of their subjects.
FileOutput diagnostic_parts(const FileHeader& source, const std::vector<ResolvedSubject>& subjects,
                            const std::vector<const Aov*>& aovs, Workers& workers);

/// One component of a diagnostic plane as float, for pictures and for the writer. `reject` is a sum of bits, exact in
/// float.
Plane<float> diagnostic_plane(const Aov& aov, int component, const ResolvedSubject& resolved, Workers& workers);

/// Whether one of these shows how several layers or samples became one color.
bool shows_combined(const std::vector<const Aov*>& aovs);

/// Which planes accumulate() must fill for these.
DiagnosticsWanted diagnostics_wanted(const std::vector<const Aov*>& aovs);

}  // namespace varve
