#include "stages/write_resolved.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "exr/convert.h"

namespace varve {
namespace {

/// Float rows into a stored plane of half or float; `value(x)` gives pixel x of the window's row.
template <class RowFiller>
RawPlane store_plane(PixelType type, const Window& window, std::atomic<std::size_t>& overflows, Workers& workers,
                     const RowFiller& fill_row) {
  RawPlane plane = make_raw_plane(type, window);
  workers.for_rows(window.y0, window.y1, [&](int y) {
    std::byte* to = plane.row(y - window.y0);
    if (type == PixelType::float32) {
      fill_row(y, reinterpret_cast<float*>(to));
      return;
    }
    std::vector<float> row(static_cast<std::size_t>(window.width()));
    fill_row(y, row.data());
    if (type == PixelType::uint32) {
      auto* integers = reinterpret_cast<std::uint32_t*>(to);
      for (int x = 0; x < window.width(); ++x) integers[x] = std::uint32_t(row[std::size_t(x)]);
    } else {
      overflows += to_half_clamped(row.data(), reinterpret_cast<std::uint16_t*>(to), row.size());
    }
  });
  return plane;
}

void add_diagnostics(FileOutput& out, OutputPart& part, const ResolvedSubject& resolved,
                     const std::vector<const Aov*>& aovs, bool several_layers, Workers& workers) {
  const Window& window = resolved.present->color.window();
  std::atomic<std::size_t> none = 0;
  for (const Aov* aov : aovs)
    for (int k = 0; k < std::max(1, int(aov->components.size())); ++k) {
      const Plane<float> values = diagnostic_plane(*aov, k, resolved, workers);
      out.planes.push_back(store_plane(aov->type, window, none, workers, [&](int y, float* row) {
        std::memcpy(row, values.row(y), sizeof(float) * std::size_t(window.width()));
      }));
      const std::string_view component = aov->components.empty() ? "" : aov->components.substr(std::size_t(k), 1);
      part.channels.push_back({{aov_channel(*aov, *resolved.subject, several_layers, component), aov->type, 1, 1, false},
                               &out.planes.back()});
    }
}

bool several_layers(const std::vector<ResolvedSubject>& subjects) {
  std::set<std::string> layers;
  for (const ResolvedSubject& s : subjects) layers.insert(s.subject->layer);
  return layers.size() > 1;
}

/// The resolved color of a subject, converted to the file's space when asked.
Plane<glm::vec4> color_to_write(const ResolvedSubject& resolved, const ColorConversion* conversion, Workers& workers) {
  if (!conversion) return {};
  Plane<glm::vec4> color = resolved.accumulated->history.color.clone();
  conversion->apply(color, workers);
  // A transform may leave the numbers (a log of a negative); outputs hold finite numbers only.
  const Window& w = color.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = 0; x < w.width(); ++x)
      for (int k = 0; k < 4; ++k) {
        float& v = color.row(y)[x][k];
        if (!(v == v)) v = 0;
        v = std::clamp(v, -std::numeric_limits<float>::max(), std::numeric_limits<float>::max());
      }
  });
  return color;
}

}  // namespace

std::string aov_channel(const Aov& aov, const Subject& subject, bool several, std::string_view component) {
  std::string name = "varve.";
  if (several && !subject.layer.empty()) name += subject.layer + ".";
  if (!subject.default_view && !subject.view.empty()) name += subject.view + ".";
  name += aov.name;
  if (!component.empty()) name += "." + std::string(component);
  return name;
}

FileOutput resolved_parts(const FileHeader& source, const FramePixels& pixels, const std::vector<ResolvedSubject>& subjects,
                          const std::vector<const Aov*>& aovs, bool keep, const ColorConversion* out_of_working_space,
                          Workers& workers) {
  FileOutput out;
  std::atomic<std::size_t> overflows = 0;
  const bool several = several_layers(subjects);
  for (int p = 0; p < int(source.parts.size()); ++p) {
    const Part& part = source.parts[std::size_t(p)];
    OutputPart to;
    to.source_part = p;
    std::set<int> replaced;
    for (const ResolvedSubject& resolved : subjects) {
      const Plane<glm::vec4> converted = color_to_write(resolved, out_of_working_space, workers);
      const Plane<glm::vec4>& color = converted.empty() ? resolved.accumulated->history.color : converted;
      bool here = false;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& ref = resolved.subject->color[k];
        if (!ref || ref->part != p) continue;
        const Channel& channel = part.channels[std::size_t(ref->channel)];
        const Window& window = part.data_window;
        out.planes.push_back(store_plane(channel.type, window, overflows, workers, [&](int y, float* row) {
          const glm::vec4* from = color.row(y);
          for (int x = 0; x < window.width(); ++x) row[x] = from[x][int(k)];
        }));
        to.channels.push_back({channel, &out.planes.back()});
        replaced.insert(ref->channel);
        here = true;
      }
      if (here) add_diagnostics(out, to, resolved, aovs, several, workers);
    }
    if (replaced.empty()) {
      if (!keep) continue;
      to.copy_chunks = true;
    } else if (keep) {
      for (int c = 0; c < int(part.channels.size()); ++c)
        if (!replaced.contains(c)) to.channels.push_back({part.channels[std::size_t(c)], &pixels[{0, p, c}]});
    }
    out.parts.push_back(std::move(to));
  }
  out.half_overflows = overflows;
  return out;
}

FileOutput diagnostic_parts(const FileHeader& source, const std::vector<ResolvedSubject>& subjects,
                            const std::vector<const Aov*>& aovs, Workers& workers) {
  FileOutput out;
  const bool several = several_layers(subjects);
  for (int p = 0; p < int(source.parts.size()); ++p) {
    OutputPart to;
    to.source_part = p;
    for (const ResolvedSubject& resolved : subjects)
      if (part_of(*resolved.subject) == p) add_diagnostics(out, to, resolved, aovs, several, workers);
    if (!to.channels.empty()) out.parts.push_back(std::move(to));
  }
  return out;
}

Plane<float> diagnostic_plane(const Aov& aov, int component, const ResolvedSubject& resolved, Workers& workers) {
  const Present& present = *resolved.present;
  const Accumulated& a = *resolved.accumulated;
  const Window& w = present.color.window();
  Plane<float> plane(w);
  const auto fill = [&](auto value) {
    workers.for_rows(w.y0, w.y1, [&](int y) {
      for (int x = 0; x < w.width(); ++x) plane.row(y)[x] = value(x, y);
    });
  };
  const auto of = [](const auto& source) { return [&source](int x, int y) { return float(source.row(y)[x]); }; };
  if (aov.name == "clip") fill(of(a.diagnostics.clip));
  if (aov.name == "weight") fill(of(a.diagnostics.weight));
  if (aov.name == "reject") fill(of(a.diagnostics.reject));
  if (aov.name == "repaired") fill([&](int x, int y) { return 1.0f - present.valid.row(y)[x]; });
  if (aov.name == "count")
    fill([&](int x, int y) { return a.history.total.row(y)[x] > 0 ? 1.0f / a.history.spread.row(y)[x] : 0.0f; });
  if (aov.name == "motion")
    fill([&](int x, int y) {
      const float v = present.motion.empty() ? 0.0f : present.motion.row(y)[x][component];
      return v == v ? v : 0.0f;  // no vector: `reject` says so; outputs hold finite numbers only
    });
  return plane;
}

DiagnosticsWanted diagnostics_wanted(const std::vector<const Aov*>& aovs) {
  DiagnosticsWanted wanted;
  for (const Aov* aov : aovs) {
    if (aov->name == "clip") wanted.clip = true;
    if (aov->name == "weight") wanted.weight = true;
    if (aov->name == "reject") wanted.reject = true;
  }
  return wanted;
}

}  // namespace varve
