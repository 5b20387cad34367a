#include "stages/input_watch.h"

#include "base/error.h"

namespace varve {
namespace {

std::vector<std::string> files_of(const InputWatch& watch, int frame) {
  std::vector<std::string> paths = {watch.input.color.path(frame)};
  for (const SequencePattern& role : watch.input.roles) paths.push_back(role.path(frame));
  if (const auto extra = watch.extras.frames.find(frame); extra != watch.extras.frames.end())
    for (const ExtraCrop& crop : extra->second)
      if (crop.path != paths.back()) paths.push_back(crop.path);  // samples of one file follow each other
  return paths;
}

}  // namespace

std::optional<std::string> changed_file(const InputWatch& watch, int frame) {
  const auto known = watch.frames.find(frame);
  if (known == watch.frames.end()) return std::nullopt;
  const std::vector<std::string> paths = files_of(watch, frame);
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (identity_of(paths[i]) != known->second.files[i]) return paths[i];
  return std::nullopt;
}

void refuse_changed(const std::string& path, int frame) {
  throw Failure(ExitCode::input, "frame " + std::to_string(frame) + ": '" + path +
                                     "' was written again while this run was using it; let its render come to an end "
                                     "and run again, with --resume to keep what is done");
}

void check_unchanged(const InputWatch& watch, int frame) {
  if (const std::optional<std::string> changed = changed_file(watch, frame)) refuse_changed(*changed, frame);
}

std::uint64_t print_of(InputWatch& watch, int frame) {
  if (const auto known = watch.frames.find(frame); known != watch.frames.end()) return known->second.print;
  const std::vector<std::string> paths = files_of(watch, frame);
  // Twice: a writer that renames its file into place is done with it.
  for (bool again = true;; again = false) {
    WatchedFrame seen{{}, kEmptyPrint};
    for (const std::string& path : paths) seen.files.push_back(identity_of(path));
    std::optional<Failure> failure;
    try {
      for (const std::string& path : paths) seen.print = add_to_print(seen.print, file_print(path));
    } catch (const Failure& half) {
      failure = half;
    }
    const std::uint64_t print = seen.print;
    watch.frames[frame] = std::move(seen);
    const std::optional<std::string> changed = changed_file(watch, frame);
    if (!changed && !failure) return print;
    watch.frames.erase(frame);
    if (again && changed) continue;
    if (changed) refuse_changed(*changed, frame);
    throw Failure(failure->code(), "frame " + std::to_string(frame) + ": " + failure->what());
  }
}

}  // namespace varve
