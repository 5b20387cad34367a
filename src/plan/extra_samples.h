// Files with further samples of frames, as whole pictures or as crops: which there are, and where their pixels belong.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plan/resolve_job.h"

namespace varve {

/// One sample of the pixels of a window of a frame.
struct ExtraCrop {
  std::string path;
  std::size_t place = 0;         ///< among the samples of the file
  Window window;                 ///< what of the file is taken, in the pixels of the frame
  int shift_x = 0, shift_y = 0;  ///< from the file's pixels to those of the frame
  bool whole = false;            ///< it has every pixel of the frame
  std::optional<Jitter> jitter;
};

struct ExtraSamples {
  std::map<int, std::vector<ExtraCrop>> frames;  ///< by frame, in the order of paths
  std::vector<std::string> notes, warnings;      ///< sentences
};

/// Reads the headers of all files that job.extra names for these frames. Files are found once each, in whatever order
/// patterns name them. A crop says where it lies by its data window, if its display window is that of the frame; else,
/// or where only a part of that was rendered, by job.extra_list, or by the member `window` of the JSON that Cycles
/// writes as `Note`: x0, y0, x1, y1 from the corner of the display window, y down, half open. Pixels beyond the data
/// window of the frame are left out, with a warning.
/// Throws Failure, with the remedy, for a crop that lies outside of its frame altogether, for windows, channels, or
/// samples that do not fit, where the place of a sample in the pixel is not told (unless that of the frames is not
/// either, or job.jitter is none), and where job asks for what further samples cannot be joined with.
ExtraSamples find_extra_samples(const ResolveJob& job, const SequenceInfo& info, const JitterSource& jitter,
                                const std::vector<int>& frames);

/// The headers of one such file, its samples found by the numbers of parts or layers.
FrameHeaders read_extra_headers(const std::string& path, int frame, const RoleRequest& roles, bool use_jitter);

/// Names, without folders, of the files that add to a frame, with commas between; "" without any.
std::string extra_files_text(const ExtraSamples& extras, int frame);

}  // namespace varve
