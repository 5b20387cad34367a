#include "stages/write_resolved.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "exr/convert.h"

namespace varve {
namespace {

/// A row of floats in a stored type; returns how many values had to be held at the ends of half.
std::size_t store_row(PixelType type, const float* from, std::byte* to, int width) {
  const auto count = static_cast<std::size_t>(width);
  if (type == PixelType::float16) return to_half_clamped(from, reinterpret_cast<std::uint16_t*>(to), count);
  if (type == PixelType::float32) {
    std::memcpy(to, from, sizeof(float) * count);
    return 0;
  }
  auto* integers = reinterpret_cast<std::uint32_t*>(to);
  for (std::size_t x = 0; x < count; ++x) integers[x] = std::uint32_t(std::clamp(double(from[x]), 0.0, 4294967295.0));
  return 0;
}

void add_diagnostics(FileOutput& out, OutputPart& part, const ResolvedSubject& resolved,
                     const std::vector<const Aov*>& aovs, bool several_layers, Workers& workers) {
  const Window& window = resolved.present->color.window();
  for (const Aov* aov : aovs)
    for (int k = 0; k < std::max(1, int(aov->components.size())); ++k) {
      const Plane<float> values = diagnostic_plane(*aov, k, resolved, workers);
      RawPlane& plane = out.planes.emplace_back(make_raw_plane(aov->type, window));
      workers.for_rows(window.y0, window.y1,
                       [&](int y) { store_row(aov->type, values.row(y), plane.row(y - window.y0), window.width()); });
      const std::string_view component = aov->components.empty() ? "" : aov->components.substr(std::size_t(k), 1);
      part.channels.push_back(
          {{aov_channel(*aov, *resolved.subject, several_layers, component), aov->type, 1, 1, false}, &plane});
    }
}

bool several_layers(const std::vector<ResolvedSubject>& subjects) {
  std::set<std::string> layers;
  for (const ResolvedSubject& s : subjects) layers.insert(s.subject->layer);
  return layers.size() > 1;
}

/// A resolved color, converted to the file's space; empty when nothing is to be converted.
Plane<glm::vec4> color_to_write(const Plane<glm::vec4>& resolved, const ColorConversion* conversion, Workers& workers) {
  if (!conversion) return {};
  Plane<glm::vec4> color = resolved.clone();
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

/// The resolved color in the stored types of its channels.
void add_color(FileOutput& out, OutputPart& to, const ResolvedSubject& resolved, const ColorConversion* conversion,
               Workers& workers) {
  const Plane<glm::vec4> converted = color_to_write(resolved.color(), conversion, workers);
  const Plane<glm::vec4>& color = converted.empty() ? resolved.color() : converted;
  const Window& window = color.window();
  std::array<RawPlane*, 4> planes{};
  for (std::size_t k = 0; k < 4; ++k)
    if (const auto& channel = resolved.subject->place.channels[k]) {
      planes[k] = &out.planes.emplace_back(make_raw_plane(channel->type, window));
      to.channels.push_back({*channel, planes[k]});
    }
  std::atomic<std::size_t> overflows = 0;
  workers.for_rows(window.y0, window.y1, [&](int y) {
    const glm::vec4* from = color.row(y);
    std::vector<float> row(static_cast<std::size_t>(window.width()));
    std::size_t held = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!planes[k]) continue;
      for (int x = 0; x < window.width(); ++x) row[std::size_t(x)] = from[x][int(k)];
      held += store_row(planes[k]->type, row.data(), planes[k]->row(y - window.y0), window.width());
    }
    overflows += held;
  });
  out.half_overflows += overflows;
}

/// The channel as it was read; all 0 where it was not.
void keep_pixels(RawPlane& to, const FramePixels& pixels, int part, int channel) {
  const bool read = std::size_t(part) < pixels.planes.size() &&
                    std::size_t(channel) < pixels.planes[std::size_t(part)].size() &&
                    !pixels.planes[std::size_t(part)][std::size_t(channel)].empty();
  if (read)
    to.storage = pixels.planes[std::size_t(part)][std::size_t(channel)].storage.clone();
  else
    to.storage.fill(std::byte{0});
}

/// The name under which a channel of the source is written.
std::string passed_on_name(const PassedOn& passed_on, const Channel& channel, ChannelRef ref) {
  for (const auto& [renamed, name] : passed_on.renamed)
    if (renamed == ref) return name;
  return channel.name;
}

bool is_dropped(const PassedOn& passed_on, ChannelRef ref) {
  return std::find(passed_on.dropped.begin(), passed_on.dropped.end(), ref) != passed_on.dropped.end();
}

/// What becomes of a part that holds nothing that is resolved.
enum class Beside { copied, rewritten, left_out };
Beside beside(const PassedOn& passed_on, const Part& part, int p) {
  std::size_t dropped = 0, renamed = 0;
  for (const ChannelRef& ref : passed_on.dropped) dropped += ref.part == p;
  for (const auto& [ref, name] : passed_on.renamed) renamed += ref.part == p;
  if (dropped == 0 && renamed == 0) return Beside::copied;
  return dropped == part.channels.size() ? Beside::left_out : Beside::rewritten;
}

/// Companions of a subject that lie in part `p`, in their stored types. Where the part reaches beyond the subject's
/// window, its channels stay as they were where they are kept.
void add_companions(FileOutput& out, OutputPart& to, const Part& part, int p, const FramePixels& pixels,
                    const ResolvedSubject& resolved, const PassedOn& passed_on, const ColorConversion* conversion,
                    Workers& workers) {
  std::atomic<std::size_t> overflows = 0;
  for (std::size_t i = 0; i < resolved.subject->companions.size(); ++i) {
    const Companion& companion = resolved.subject->companions[i];
    const auto lies_here = [&](const auto& ref) { return ref && ref->part == p; };
    if (std::none_of(companion.channels.begin(), companion.channels.end(), lies_here)) continue;
    const Plane<glm::vec4>& history = resolved.companion(i);
    const Plane<glm::vec4> converted = color_to_write(history, companion.color ? conversion : nullptr, workers);
    const Plane<glm::vec4>& values = converted.empty() ? history : converted;
    const Window common = intersect(values.window(), part.data_window);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& ref = companion.channels[k];
      if (!lies_here(ref)) continue;
      const Channel& channel = part.channels[std::size_t(ref->channel)];
      RawPlane& plane = out.planes.emplace_back(make_raw_plane(channel.type, part.data_window));
      if (common != part.data_window) keep_pixels(plane, pixels, p, ref->channel);
      const std::size_t left = std::size_t(common.x0 - part.data_window.x0) * bytes_per_pixel(channel.type);
      workers.for_rows(common.y0, common.y1, [&](int y) {
        std::vector<float> row(static_cast<std::size_t>(common.width()));
        for (int x = common.x0; x < common.x1; ++x) row[std::size_t(x - common.x0)] = values.at(x, y)[int(k)];
        overflows += store_row(channel.type, row.data(), plane.row(y - part.data_window.y0) + left, common.width());
      });
      to.channels.push_back({channel, &plane});
      to.channels.back().channel.name = passed_on_name(passed_on, channel, *ref);
    }
  }
  out.half_overflows += overflows;
}

/// Diagnostic planes that an earlier resolve, of this layer or of several, may have left for a subject: they say
/// nothing of this one.
std::set<std::string> stale_diagnostics(const Subject& subject) {
  std::set<std::string> names;
  for (const Aov& aov : diagnostic_aovs())
    for (const bool several : {false, true})
      for (int k = 0; k < std::max(1, int(aov.components.size())); ++k)
        names.insert(
            aov_channel(aov, subject, several, aov.components.empty() ? "" : aov.components.substr(std::size_t(k), 1)));
  return names;
}

/// The part's other channels as they were, unless one of that name is written already or is out of date,
/// or means nothing now that a deep part is flat.
void add_kept(OutputPart& to, const Part& part, int p, const std::vector<RawPlane>& pixels, const PassedOn& passed_on,
              std::set<std::string> taken) {
  for (const OutputChannel& channel : to.channels) taken.insert(channel.channel.name);
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    const ChannelRef ref{0, p, int(c)};
    Channel channel = part.channels[c];
    channel.name = passed_on_name(passed_on, channel, ref);
    if (is_deep(part) && pixels[c].empty()) continue;
    if (!is_dropped(passed_on, ref) && taken.insert(channel.name).second) to.channels.push_back({channel, &pixels[c]});
  }
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

FileOutput resolved_parts(const FileHeader& source, const FramePixels& pixels,
                          const std::vector<ResolvedSubject>& subjects, const std::vector<const Aov*>& aovs, bool keep,
                          const PassedOn& passed_on, const ColorConversion* out_of_working_space, Workers& workers) {
  FileOutput out;
  const bool several = several_layers(subjects);
  for (int p = 0; p < int(source.parts.size()); ++p) {
    const Part& part = source.parts[std::size_t(p)];
    OutputPart to;
    to.source_part = p;
    std::set<std::string> stale;
    for (const ResolvedSubject& resolved : subjects) {
      add_companions(out, to, part, p, pixels, resolved, passed_on, out_of_working_space, workers);
      if (resolved.subject->place.part != p) continue;
      stale.merge(stale_diagnostics(*resolved.subject));
      add_color(out, to, resolved, out_of_working_space, workers);
      add_diagnostics(out, to, resolved, aovs, several, workers);
    }
    const Beside otherwise = beside(passed_on, part, p);
    if (to.channels.empty() && (!keep || otherwise == Beside::left_out)) continue;
    to.copy_chunks = to.channels.empty() && otherwise == Beside::copied;
    if (!to.copy_chunks && keep) add_kept(to, part, p, pixels.planes[std::size_t(p)], passed_on, std::move(stale));
    out.parts.push_back(std::move(to));
  }
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
      if (resolved.subject->place.part == p) add_diagnostics(out, to, resolved, aovs, several, workers);
    if (!to.channels.empty()) out.parts.push_back(std::move(to));
  }
  return out;
}

Plane<float> diagnostic_plane(const Aov& aov, int component, const ResolvedSubject& resolved, Workers& workers) {
  const Present& present = *resolved.present;
  const Accumulated& a = *resolved.accumulated;
  const Window& w = present.color.window();
  Plane<float> plane(w, 0, 0.0f);
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
  if (aov.name == "prediction") fill([&](int x, int y) { return resolved.prediction->color.row(y)[x][component]; });
  if (aov.name == "count")
    fill([&](int x, int y) { return a.history.total.row(y)[x] > 0 ? 1.0f / a.history.spread.row(y)[x] : 0.0f; });
  if (aov.name == "blur-variance") fill(of(a.diagnostics.blur));
  if (aov.name == "residual") fill(of(a.diagnostics.residual));
  if (aov.name == "count-past") fill(of(a.diagnostics.count_past));
  if (aov.name == "count-future") fill(of(a.diagnostics.count_future));
  if (aov.name == "variance") fill(of(a.diagnostics.variance));
  if (aov.name == "frames") fill(of(a.diagnostics.frames));
  if (aov.name == "surfaces") fill(of(a.diagnostics.surfaces));
  if (aov.name == "gain") fill(of(a.diagnostics.gain));
  if (aov.name == "removed") fill(of(a.diagnostics.removed));
  if (aov.name == "round-trip") fill(of(a.diagnostics.round_trip));
  if (aov.name == "evaluation" && resolved.lacking) fill(of(*resolved.lacking));
  if (aov.name == "reject-future") fill(of(a.diagnostics.reject_future));
  const auto of_repair = [&](auto MotionRepair::*source) {
    if (!resolved.repair || (resolved.repair->*source).empty())
      fill([](int, int) { return 0.0f; });
    else
      fill(of(resolved.repair->*source));
  };
  if (aov.name == "vector-residual") of_repair(&MotionRepair::residual);
  if (aov.name == "vector-repair") of_repair(&MotionRepair::how);
  // 0 where nothing was combined.
  const auto fill_combined = [&](const Plane<float>& source) {
    fill([&](int x, int y) { return source.empty() ? 0.0f : source.row(y)[x]; });
  };
  if (aov.name == "layer-index") fill_combined(present.combined.winner);
  if (aov.name == "layer-variation") fill_combined(present.combined.variation);
  if (aov.name == "layer-difference" && resolved.difference) fill(of(*resolved.difference));
  if (aov.name == "layers") fill_combined(present.combined.touched);
  const float size = resolved.shown_quarter ? 2.0f : 1.0f;  // pixels written to one of the frame, along an edge
  if (aov.name == "motion")
    fill([&](int x, int y) {
      const float v = present.motion.empty() ? 0.0f : size * present.motion.row(y)[x][component];
      return v == v ? v : 0.0f;  // no vector: `reject` says so; outputs hold finite numbers only
    });
  return plane;
}

bool shows_combined(const std::vector<const Aov*>& aovs) {
  return std::any_of(aovs.begin(), aovs.end(), [](const Aov* aov) {
    return aov->name == "layer-index" || aov->name == "layer-variation" || aov->name == "layers";
  });
}

DiagnosticsWanted diagnostics_wanted(const std::vector<const Aov*>& aovs) {
  DiagnosticsWanted wanted;
  for (const Aov* aov : aovs) {
    if (aov->name == "clip") wanted.clip = true;
    if (aov->name == "weight") wanted.weight = true;
    if (aov->name == "reject" || aov->name == "reject-future") wanted.reject = true;
    if (aov->name == "evaluation") wanted.reject = wanted.gather = true;
    if (aov->name == "count-past" || aov->name == "count-future") wanted.counts = true;
    if (aov->name == "blur-variance") wanted.blur = true;
    if (aov->name == "residual") wanted.residual = true;
    if (aov->filled_by == kByGather) wanted.gather = true;
  }
  return wanted;
}

}  // namespace varve
