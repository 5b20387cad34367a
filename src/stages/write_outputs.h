// The files of one resolved frame.
#pragma once

#include "stages/set_up.h"
#include "stages/source_frame.h"
#include "stages/write_resolved.h"

namespace varve {

/// The file's pixels as stored, for what stands beside the color when it is written.
FileSet read_beside(const Setup& s, const FrameHeaders& headers, Workers& workers);

/// Writes the frame under `path`, and its diagnostics and pictures where they go into files of their own. `pixels` are
/// those of read_beside(). Returns how many values had to be held at the ends of half. Throws what write_frame throws.
std::size_t write_outputs(const Setup& s, const std::string& path, const FrameHeaders& headers, const FileSet& pixels,
                          const std::vector<ResolvedSubject>& resolved, const std::string& frames_used,
                          const std::string& extras_used, Workers& workers);

}  // namespace varve
