#include "stages/previews.h"

#include <algorithm>
#include <cstdio>
#include <functional>

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
  char digits[16];
  std::snprintf(digits, sizeof digits, frame < 0 ? ".%05d.png" : ".%04d.png", frame);
  const std::string number = digits;
  std::vector<std::function<void()>> pictures;  // encoding a PNG takes longer than resolving: side by side
  for (const ResolvedSubject& resolved : subjects) {
    std::string prefix = folder + "/";
    if (subjects.size() > 1 && !resolved.subject->layer.empty()) prefix += file_name(resolved.subject->layer) + ".";
    if (subjects.size() > 1 && !resolved.subject->view.empty()) prefix += file_name(resolved.subject->view) + ".";
    pictures.emplace_back([=, &resolved] { write_color_png(prefix + "color" + number, resolved.color(), display); });
    for (const Aov* aov : aovs)
      for (int k = 0; k < std::max(1, int(aov->components.size())); ++k) {
        std::string name = prefix + std::string(aov->name);
        if (aov->components.size() > 1) name += std::string(".") + aov->components[std::size_t(k)];
        pictures.emplace_back([=, &resolved] {
          Workers alone(1);
          write_map_png(name + number, diagnostic_plane(*aov, k, resolved, alone), std::string(aov->colormap),
                        aov->preview_low, aov->preview_high);
        });
      }
  }
  workers.for_each(pictures.size(), [&](std::size_t i, int) { pictures[i](); });
}

}  // namespace varve
