#include "stages/read_extras.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace varve {
namespace {

/// Crops that become one present.
struct Group {
  std::optional<Jitter> jitter;
  std::vector<const ExtraCrop*> crops;
  Window around;           // all of them
  std::size_t pixels = 0;  // in all of them

  bool takes(const ExtraCrop& crop, bool compact) const {
    // What lies between them takes room as well.
    if (compact && unite(around, crop.window).pixels() > 2 * (pixels + crop.window.pixels())) return false;
    const bool same = jitter.has_value() == crop.jitter.has_value() &&
                      (!jitter || (jitter->x == crop.jitter->x && jitter->y == crop.jitter->y));
    return same && std::all_of(crops.begin(), crops.end(),
                               [&](const ExtraCrop* other) { return intersect(other->window, crop.window).empty(); });
  }
};

std::vector<Group> group_crops(const std::vector<ExtraCrop>& crops, bool compact) {
  std::vector<Group> groups;
  for (const ExtraCrop& crop : crops) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.takes(crop, compact); });
    if (group == groups.end()) group = groups.insert(groups.end(), {crop.jitter, {}, {}, 0});
    group->crops.push_back(&crop);
    group->around = unite(group->around, crop.window);
    group->pixels += crop.window.pixels();
  }
  return groups;
}

/// Calls use(to, from, background) with each plane that both have.
template <class Use>
void each_plane(Present& to, const Present& from, const Use& use) {
  const float nowhere = std::numeric_limits<float>::quiet_NaN();
  use(to.color, from.color, glm::vec4(0));
  to.companions.resize(from.companions.size());
  for (std::size_t k = 0; k < from.companions.size(); ++k) use(to.companions[k], from.companions[k], glm::vec4(0));
  use(to.motion, from.motion, glm::vec2(nowhere));
  use(to.forward, from.forward, glm::vec2(nowhere));
  use(to.depth, from.depth, std::numeric_limits<float>::infinity());
  use(to.id, from.id, 0u);
  use(to.normal, from.normal, glm::vec3(0));
  use(to.reactive, from.reactive, 0.0f);
  use(to.responsive, from.responsive, 1.0f);
}

/// Adds the pixels of a crop, read in the coordinates of its file.
void paste(Present& canvas, const Present& crop, const ExtraCrop& where, const Window& window) {
  const auto copy = [&](auto& to, const auto& from, auto background) {
    if (from.empty()) return;
    if (to.empty()) to = std::decay_t<decltype(to)>(window, from.border(), background);
    for (int y = where.window.y0; y < where.window.y1; ++y)
      for (int x = where.window.x0; x < where.window.x1; ++x)
        to.at(x, y) = from.at(x - where.shift_x, y - where.shift_y);
  };
  each_plane(canvas, crop, copy);
  copy(canvas.valid, crop.valid, 0.0f);
  canvas.companion_is_color = crop.companion_is_color;
  canvas.not_finite += crop.not_finite;
  canvas.companions_not_finite += crop.companions_not_finite;
}

/// Everywhere but in the crops it is what the frame's own sample is, and no sample.
void fill_around(Present& canvas, const Present& own, const std::vector<Window>& covered, Workers& workers) {
  const Window w = canvas.color.window();
  Plane<std::uint8_t> inside(w, 0, 0);
  for (const Window& crop : covered) {
    const Window c = intersect(crop, w);
    for (int y = c.y0; y < c.y1; ++y)
      std::fill(inside.row(y) + (c.x0 - w.x0), inside.row(y) + (c.x1 - w.x0), std::uint8_t(1));
  }
  each_plane(canvas, own, [&](auto& to, const auto& from, auto) {
    if (from.empty()) {
      to = {};
      return;
    }
    const bool lacks = to.empty();
    if (lacks) to = std::decay_t<decltype(to)>(w, from.border());
    workers.for_rows(w.y0, w.y1, [&](int y) {
      for (int x = w.x0; x < w.x1; ++x)
        if (lacks || inside.at(x, y) == 0) to.at(x, y) = from.at(x, y);
    });
  });
  canvas.rows_valid.assign(std::size_t(w.height()), 1);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x)
      if (!(canvas.valid.at(x, y) > 0)) canvas.rows_valid[std::size_t(y - w.y0)] = 0;
  });
}

/// One file, read for all outputs of the frame.
struct ExtraFile {
  FrameHeaders headers;
  FileSet pixels;
};

ExtraFile read_file(const SourceOptions& options, const std::string& path, int frame, const ChannelNeeds& needs,
                    Workers& workers) {
  ExtraFile file{read_extra_headers(path, frame, options.job.roles, options.job.jitter != "none"), {}};
  DeepFrame none;
  file.pixels = read_files(file.headers, needs, none, workers);
  return file;
}

/// What it has of one output, in its own pixels.
Present read_crop(const SourceOptions& options, const ExtraFile& file, const ExtraCrop& crop, const Subject& subject,
                  const Window& display, const ReadOptions& read, Workers& workers) {
  const std::vector<ColorOutput>& outputs = file.headers.outputs;
  const auto output = std::find_if(outputs.begin(), outputs.end(), [&](const ColorOutput& other) {
    return other.subject.layer == subject.layer && other.subject.view == subject.view;
  });
  const auto changed = [&] {
    return Failure(ExitCode::inconsistent,
                   "'" + crop.path + "' is not what it was when the work began; start again when it is complete");
  };
  if (output == outputs.end() || crop.place >= output->inputs.size()) throw changed();
  const Subject& sample = file.headers.subjects[output->inputs[crop.place]];
  const Part& part = file.headers.files.front().parts[std::size_t(part_of(sample))];
  const Window& w = crop.window;
  const Window taken{w.x0 - crop.shift_x, w.y0 - crop.shift_y, w.x1 - crop.shift_x, w.y1 - crop.shift_y};
  if (intersect(taken, part.data_window) != taken) throw changed();
  std::size_t vectors_bad = 0;
  return read_present(sample, file.pixels, part.data_window, display, read, options.into_working_space, vectors_bad,
                      workers);
}

}  // namespace

std::vector<std::vector<Present>> read_extras(const SourceOptions& options, const FrameHeaders& headers,
                                              const std::vector<Present>& own, const ReadOptions& read,
                                              const ChannelNeeds& needs, bool compact,
                                              const std::function<void(Present&, std::size_t subject)>& move,
                                              Workers& workers) {
  std::vector<std::vector<Present>> extras;
  const auto found = options.extras.frames.find(headers.frame);
  if (found == options.extras.frames.end()) return extras;
  extras.resize(headers.outputs.size());
  for (const Group& group : group_crops(found->second, compact)) {
    std::vector<Present> canvases(headers.outputs.size());
    std::vector<Window> covered;
    for (const ExtraCrop* crop : group.crops) {
      const ExtraFile file = read_file(options, crop->path, headers.frame, needs, workers);
      for (std::size_t o = 0; o < headers.outputs.size(); ++o) {
        const Window& window = own[headers.outputs[o].inputs.front()].color.window();
        const Window& display =
            headers.files.front().parts[std::size_t(headers.outputs[o].subject.place.part)].display_window;
        const Present pixels = read_crop(options, file, *crop, headers.outputs[o].subject, display, read, workers);
        ExtraCrop inside = *crop;
        inside.window = intersect(crop->window, window);
        paste(canvases[o], pixels, inside, compact ? intersect(group.around, window) : window);
      }
      covered.push_back(crop->window);
    }
    for (std::size_t o = 0; o < headers.outputs.size(); ++o) {
      const std::size_t subject = headers.outputs[o].inputs.front();
      Present& canvas = canvases[o];
      if (group.jitter) canvas.jitter = glm::dvec2(group.jitter->x, group.jitter->y);
      move(canvas, subject);
      fill_around(canvas, own[subject], covered, workers);
      extras[o].push_back(std::move(canvas));
    }
  }
  return extras;
}

}  // namespace varve
