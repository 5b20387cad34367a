#include "stages/gather_frame.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "diagnose/color_print.h"
#include "gather/opposite_vectors.h"
#include "gather/round_trip.h"
#include "gather/shading_gain.h"

namespace varve {
namespace {

constexpr double kRoundTrip = 0.05;  // px: an inverted vector that misses its sample by more is none

/// What a frame has of a sample that it lacks.
const Present& nothing() {
  static const Present none;
  return none;
}

/// The frames of one subject, with what is made for them: one of the samples of each pixel.
struct SubjectFrames {
  const FrameWindow& window;
  std::size_t subject, sample;
  std::optional<std::size_t> further;  // place among the further samples of a frame; none: it is the subject itself
  std::size_t output;
  const SubjectFrames* leader;  // the first sample, which all frames have everywhere; null: it is this one
  std::size_t first, last;      // held, of one shot
  const GatherParameters& parameters;
  const RepairParameters& repair;
  GatherMemory& memory;
  SurfaceTest test;
  Workers& workers;

  const Present& present(std::size_t i) const {
    if (!further) return window[i].presents[subject];
    const auto& extras = window[i].extras;
    return output < extras.size() && *further < extras[output].size() ? extras[output][*further] : nothing();
  }
  bool is_there(std::size_t i) const { return !further || !present(i).color.empty(); }
  bool is_whole(std::size_t i) const {
    if (!further) return true;
    const std::vector<std::uint8_t>& rows = present(i).rows_valid;
    return is_there(i) && present(i).color.window() == leader->present(i).color.window() &&
           std::find(rows.begin(), rows.end(), 0) == rows.end();
  }
  /// The sample that those of frame `i` lead to in frame `to`.
  const SubjectFrames& led_to(std::size_t i, std::size_t to) const {
    return !further || (is_whole(i) && is_whole(to)) ? *this : *leader;
  }

  GatherSource bare(std::size_t i) const {
    GatherSource s;
    s.present = &present(i);
    s.sample = sample;
    s.whole = is_whole(i);
    if (!is_there(i)) return s;
    SurfaceBlocks& blocks = memory[i].blocks;
    if (blocks.blocks.empty()) blocks = summarize_surfaces(present(i));
    s.blocks = &blocks;
    if (s.present->jitter) s.jitter = *s.present->jitter;
    return s;
  }

  SeenFrame seen(std::size_t i) const {
    SeenPlanes& planes = memory[i].seen;
    if (planes.empty()) planes.light = light_of(present(i).color, workers);
    return SeenPlanes::seen_frame(planes.light, present(i).depth, present(i).id,
                                  present(i).jitter.value_or(glm::dvec2(0)));
  }

  /// Vectors to the neighbor `to`, from the file or turned round from the neighbor's own.
  const Plane<glm::vec2>* vectors(std::size_t i, std::size_t to) const {
    if (to < first || to > last) return nullptr;
    const bool future = to > i;
    const SubjectFrames& there = led_to(i, to);
    const Plane<glm::vec2>&stored = future ? present(i).forward : present(i).motion,
          &back = future ? there.present(to).motion : there.present(to).forward;
    const bool tests = repair.mode != RepairMotion::off && !further;
    if (stored.empty() && back.empty()) return nullptr;
    if (!stored.empty() && !tests && (back.empty() || !(parameters.return_tolerance > 0))) return &stored;
    Plane<glm::vec2>& made = future ? memory[i].forward : memory[i].backward;
    if (!made.empty()) return &made;
    if (stored.empty()) {
      made = opposite_vectors(bare(i), there.bare(to), tests ? *vectors(to, i) : back, test, kRoundTrip, workers);
      return &made;
    }
    Plane<glm::vec2> own = stored.clone();
    MotionRepair& said = future ? memory[i].forward_said : memory[i].backward_said;
    if (tests) {
      const CamerasAround cameras = cameras_of(window[i], subject);
      const Plane<glm::vec2> resting = resting_motion(future ? cameras.after : cameras.before, present(i).depth,
                                                      present(i).jitter.value_or(glm::dvec2(0)), workers);
      said = repair_motion(own, seen(i), seen(to), back, resting, repair, workers);
    }
    if (!back.empty() && parameters.return_tolerance > 0) {
      made = trusted_vectors(bare(i), own, there.bare(to), back, test, parameters.return_tolerance, workers);
      keep_repaired(made, own, said, workers);
    } else {
      made = std::move(own);
    }
    return &made;
  }

  GatherSource source(std::size_t i) const {
    GatherSource s = bare(i);
    if (!is_there(i)) return s;
    if (i > first) s.backward = vectors(i, i - 1);
    if (i < last) s.forward = vectors(i, i + 1);
    const auto made = memory.find(i);
    if (made != memory.end() && !made->second.light.empty())
      s.local_light = &made->second.light, s.light_range = &made->second.range;
    return s;
  }

  std::uint64_t print(std::size_t i) const {
    std::optional<std::uint64_t>& made = memory[i].print;
    if (!made) made = color_print(present(i).color, workers);
    return *made;
  }

  /// A held or doubled frame shows nothing new: of frames that are the same to the last bit and sampled at the same
  /// place, the one nearest to the resolved frame counts, the earlier of two. Vectors are followed through the others.
  /// Equal pictures of other places are news: a plain edge looks the same from half of all places.
  bool repeats(std::size_t i, std::size_t begin, std::size_t end, std::size_t resolved) const {
    const auto rank = [&](std::size_t k) {
      return k > resolved ? 2 * (k - resolved) : k == resolved ? 0 : 2 * (resolved - k) - 1;
    };
    if (!is_there(i)) return false;
    for (std::size_t k = begin; k <= end && print(i) != 0; ++k)
      if (is_there(k) && print(k) == print(i) && present(k).jitter == present(i).jitter && rank(k) < rank(i))
        return true;
    return false;
  }
};

/// Frame after frame, all samples of each.
std::vector<GatherSource> sources(const std::vector<SubjectFrames>& samples, std::size_t begin, std::size_t end,
                                  std::size_t resolved) {
  std::vector<GatherSource> list;
  for (std::size_t i = begin; i <= end; ++i)
    for (const SubjectFrames& frames : samples) {
      list.push_back(frames.source(i));
      list.back().repeats = frames.repeats(i, begin, end, resolved);
    }
  return list;
}

std::size_t back(std::size_t index, int frames, std::size_t first) {
  return index - std::min(index - first, std::size_t(frames));
}
std::size_t ahead(std::size_t index, int frames, std::size_t last) {
  return index + std::min(last - index, std::size_t(frames));
}

/// A first, cheap picture of a frame, good enough to measure light in: its direct neighbors only, few cells. All
/// samples are in it, and each looks at it with surfaces of its own.
void make_light(const std::vector<SubjectFrames>& samples, std::size_t i, const GatherParameters& parameters) {
  const SubjectFrames& any = samples.front();
  if (!any.memory[i].light.empty()) return;
  GatherParameters pilot = parameters;
  pilot.gain = false;
  pilot.filter = SampleFilter::none;
  pilot.cells = std::min(parameters.cells, 2);
  const std::size_t begin = back(i, 1, any.first), end = ahead(i, 1, any.last);
  const Accumulated made = gather(sources(samples, begin, end, i), i - begin, pilot, any.test, {}, any.workers);
  const Plane<glm::vec4>& picture = made.history.color;
  for (const SubjectFrames& frames : samples) {
    if (!frames.is_there(i)) continue;
    Plane<float>& light = frames.memory[i].light;
    light = local_light(picture, frames.present(i), frames.test, parameters.gain_window, frames.workers);
    follow_sudden_light(light, picture, frames.present(i), frames.test, parameters.gain_window, frames.workers);
    frames.memory[i].range = local_range(picture, frames.present(i), frames.test, frames.workers);
  }
}

/// Samples are named by 16 bits on each axis.
void check_size(const SourceFrame& frame, const Window& window) {
  constexpr int most = 65536;
  if (window.width() > most || window.height() > most)
    throw Failure(ExitCode::inconsistent, "frame " + std::to_string(frame.headers.frame) + ": its data window is " +
                                              std::to_string(window.width()) + "x" + std::to_string(window.height()) +
                                              " pixels, and --accumulator gather takes at most " +
                                              std::to_string(most) +
                                              " on an edge; crop it, or give --accumulator recursive");
}

/// The most further samples that one of these frames has.
std::size_t most_further(const FrameWindow& window, std::size_t output, std::size_t first, std::size_t last) {
  std::size_t most = 0;
  for (std::size_t i = first; i <= last; ++i)
    if (output < window[i].extras.size()) most = std::max(most, window[i].extras[output].size());
  return most;
}

}  // namespace

Accumulated gather_frame(const FrameWindow& window, std::size_t output, std::span<const std::size_t> subjects,
                         std::size_t index, std::size_t first, std::size_t last, const GatherParameters& parameters,
                         const RepairParameters& repair, std::vector<GatherMemory>& memory,
                         const DiagnosticsWanted& wanted, Workers& workers) {
  const std::size_t all = subjects.size() + most_further(window, output, first, last);
  if (memory.size() < all) memory.resize(all);
  for (GatherMemory& frames : memory)
    std::erase_if(frames, [&](const auto& entry) { return entry.first < first || entry.first > last; });
  std::vector<SubjectFrames> samples;
  samples.reserve(all);  // they point to the first of them
  const SurfaceTest test = surface_test(window[index].presents[subjects.front()]);
  for (std::size_t s = 0; s < all; ++s) {
    const bool own = s < subjects.size();
    const std::size_t subject = own ? subjects[s] : subjects.front();
    for (std::size_t i = first; own && i <= last; ++i)
      check_size(window[i], window[i].presents[subject].color.window());
    const auto further = own ? std::nullopt : std::optional<std::size_t>(s - subjects.size());
    samples.push_back({window, subject, s, further, output, s > 0 ? &samples.front() : nullptr, first, last, parameters,
                       repair, memory[s], test, workers});
  }
  const std::size_t begin = back(index, parameters.reach, first), end = ahead(index, parameters.reach, last);
  if (parameters.gain)
    for (std::size_t i = begin; i <= end; ++i) make_light(samples, i, parameters);
  return gather(sources(samples, begin, end, index), index - begin, parameters, test, wanted, workers);
}

}  // namespace varve
