#include "stages/previews.h"

#include <cstdio>

#include "exr/pictures.h"

namespace varve {
namespace {

/// Channel or layer names may hold anything; file names should not.
std::string file_name(std::string name) {
  for (char& c : name)
    if (c == '/' || c == '\\' || c == ' ') c = '_';
  return name;
}

}  // namespace

void write_previews(const std::string& folder, int frame, const std::vector<ResolvedSubject>& subjects,
                    const std::vector<const Aov*>& aovs, const DisplayTransform* display, Workers& workers) {
  char number[16];
  std::snprintf(number, sizeof number, frame < 0 ? ".%05d.png" : ".%04d.png", frame);
  for (const ResolvedSubject& resolved : subjects) {
    std::string prefix = folder + "/";
    if (subjects.size() > 1 && !resolved.subject->layer.empty()) prefix += file_name(resolved.subject->layer) + ".";
    if (subjects.size() > 1 && !resolved.subject->view.empty()) prefix += file_name(resolved.subject->view) + ".";
    write_color_png(prefix + "color" + number, resolved.accumulated->history.color, display);
    for (const Aov* aov : aovs) {
      const int components = aov->components.empty() ? 1 : int(aov->components.size());
      for (int k = 0; k < components; ++k) {
        std::string name = prefix + std::string(aov->name);
        if (components > 1) name += std::string(".") + aov->components[std::size_t(k)];
        write_map_png(name + number, diagnostic_plane(*aov, k, resolved, workers), std::string(aov->colormap),
                      aov->preview_low, aov->preview_high);
      }
    }
  }
}

}  // namespace varve
