#include "stages/write_outputs.h"

#include "base/version.h"
#include "exr/write_frame.h"
#include "stages/double_resolution.h"
#include "stages/place_samples.h"
#include "stages/previews.h"

namespace varve {

namespace {

WriteOptions write_options(const Setup& s, const Provenance& provenance, const std::function<void()>& check) {
  WriteOptions options{s.job.zip_level,
                       {{"varve:version", version()},
                        {"varve:parameters", s.parameters},
                        {"varve:hash", s.hash},
                        {"varve:frames", provenance.frames},
                        {"varve:inputs", provenance.inputs}},
                       check};
  if (!provenance.extra.empty()) options.attributes.push_back({"varve:extra", provenance.extra});
  return options;
}

}  // namespace

FileSet read_beside(const Setup& s, const FrameHeaders& headers, Workers& workers) {
  if (!s.job.request.keep_channels) return FileSet(headers.files.size());
  DeepFrame told;  // when the frame was read for the resolve
  return in_frame(headers.frame, [&] {
    FileSet pixels = read_files(headers, {.whole_parts = true, .rule = s.job.roles.combine_layers.rule}, told, workers);
    divide_passed_vectors(headers, pixels.front(), workers);
    return pixels;
  });
}

std::size_t write_outputs(const Setup& s, const std::string& path, const FrameHeaders& headers, const FileSet& pixels,
                          const std::vector<ResolvedSubject>& resolved, const Provenance& provenance,
                          const std::function<void()>& check, Workers& workers) {
  const FileHeader &source = headers.files.front(), &stored = files_on_disk(headers).front();
  const WriteOptions options = write_options(s, provenance, check);
  const std::vector<const Aov*> none;
  const bool apart = s.job.diagnostics.has_value();
  const auto at_size = [&](const PartsOf& parts_of) {
    return s.job.parameters.subpixel.scale > 1 ? double_resolution(headers, pixels.front(), resolved, parts_of, workers)
                                               : parts_of(resolved);
  };
  FileOutput color = at_size([&](const std::vector<ResolvedSubject>& colors) {
    return resolved_parts(source, pixels.front(), colors, apart ? none : s.aovs, s.job.request.keep_channels,
                          headers.passed_on, s.out_of_working_space ? &*s.out_of_working_space : nullptr, workers);
  });
  for (OutputPart& part : color.parts)
    if (!part.copy_chunks) part.compression = s.job.compression;
  place_samples(headers, color.parts);
  if (apart) {
    FileOutput diagnostics = at_size(
        [&](const std::vector<ResolvedSubject>& colors) { return diagnostic_parts(source, colors, s.aovs, workers); });
    place_samples(headers, diagnostics.parts);
    write_frame(s.job.diagnostics->path(headers.frame), stored, diagnostics.parts, options, workers);
  }
  if (!s.job.preview_folder.empty())
    write_previews(s.job.preview_folder, headers.frame, resolved, s.aovs, s.display ? &*s.display : nullptr, workers);
  // The resolved frame goes last: once it is there, everything that belongs to it is.
  write_frame(path, stored, color.parts, options, workers);
  return color.half_overflows;
}

}  // namespace varve
