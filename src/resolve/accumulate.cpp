#include "resolve/accumulate.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "resolve/accumulate_companions.h"
#include "resolve/accumulate_row.h"
#include "resolve/row_passes.h"
#include "resolve/sample_weights.h"

namespace varve {
namespace {

template <class P>
auto* floats(P& pixels) {
  using Float =
      std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(*pixels.row(0))>>, const float, float>;
  return reinterpret_cast<Float*>(pixels.row(pixels.window().y0));
}

/// A plane of T as rows of floats, T made of floats only.
template <class T>
PixelRows<const float> read_rows(const Plane<T>& plane) {
  if (plane.empty()) return {nullptr, 0};
  return {floats(plane), plane.stride() * std::ptrdiff_t(sizeof(T) / sizeof(float))};
}
template <class T>
PixelRows<float> write_rows(Plane<T>& plane) {
  if (plane.empty()) return {nullptr, 0};
  return {floats(plane), plane.stride() * std::ptrdiff_t(sizeof(T) / sizeof(float))};
}

/// The neighborhood's samples in the space of the box, border and all.
Plane<glm::vec4> rotate_to_ycocg(const Plane<glm::vec4>& color, Workers& workers) {
  const Window& w = color.window();
  const int b = color.border();
  Plane<glm::vec4> out(w, b);
  workers.for_rows(w.y0 - b, w.y1 + b, [&](int y) {
    const glm::vec4* from = color.row(y) - b;
    glm::vec4* to = out.row(y) - b;
    for (int x = 0; x < w.width() + 2 * b; ++x) {
      const glm::vec4 c = from[x];
      const float rb = c.r * 0.25f + c.b * 0.25f;
      to[x] = {rb + c.g * 0.5f, c.r * 0.5f - c.b * 0.5f, c.g * 0.5f - rb, c.a};
    }
  });
  return out;
}

/// The steps of a row, as compiled for one processor.
struct RowKernel {
  decltype(&baseline::fetch_history) fetch_history;
  decltype(&baseline::rectify_history) rectify_history;
  decltype(&baseline::blend_present) blend_present;
};

RowKernel kernel_for(Isa isa) {
#ifdef VARVE_HAVE_AVX2
  if (isa != Isa::baseline && __builtin_cpu_supports("avx2"))
    return {avx2::fetch_history, avx2::rectify_history, avx2::blend_present};
#endif
  (void)isa;
  return {baseline::fetch_history, baseline::rectify_history, baseline::blend_present};
}

/// Row buffers of one worker.
struct Scratch {
  Plane<glm::vec4> history;
  Plane<float> total, spread;
  Plane<std::uint32_t> reject;
  Plane<float> trust, steadiness;
  Plane<double> present_weight;
  RowCounts counts{};
  std::array<std::size_t, kRejectBits> rejected{};

  Scratch(int width, bool weighs)
      : history(Window{0, 0, width, 1}),
        total(Window{0, 0, width, 1}),
        spread(Window{0, 0, width, 1}),
        reject(Window{0, 0, width, 1}) {
    if (!weighs) return;
    trust = Plane<float>(Window{0, 0, width, 1});
    steadiness = Plane<float>(Window{0, 0, width, 1});
    present_weight = Plane<double>(Window{0, 0, width, 1});
  }
  RowScratch view() {
    return {floats(history), total.row(0), spread.row(0), reject.row(0),
            present_weight.empty() ? nullptr : present_weight.row(0)};
  }
  RowPassScratch extra() {
    if (present_weight.empty()) return {};
    return {trust.row(0), steadiness.row(0), present_weight.row(0)};
  }
};

History make_history(const Window& w) {
  History h;
  h.color = Plane<glm::vec4>(w);
  h.total = Plane<float>(w);
  h.spread = Plane<float>(w);
  h.rows_valid.resize(std::size_t(w.height()));
  return h;
}

/// The present as the kernel reads it, and the planes made for that.
struct PresentView {
  WeighedPresent weighed;    // what is blended in where samples are weighed by their position
  Plane<glm::vec4> rotated;  // the neighborhood in the space of the box
  Plane<glm::vec2> at_rest;  // without vectors every pixel stays where it is
  std::vector<std::uint8_t> rows_valid;
};

PresentView view_present(AccumulateView& v, const Present& present, const RectifyParameters& rectify,
                         SampleFilter sample_filter, std::optional<glm::dvec2> jitter, Workers& workers) {
  const Window& w = present.color.window();
  PresentView made;
  if (sample_filter != SampleFilter::none && jitter)
    made.weighed = weigh_samples(present, sample_filter, *jitter, workers);
  if (rectify.box != Box::none && rectify.space == BoxSpace::ycocg)
    made.rotated = rotate_to_ycocg(present.color, workers);
  if (present.motion.empty()) made.at_rest = Plane<glm::vec2>(w, 0, glm::vec2(0.0f));

  v.width = w.width();
  v.height = w.height();
  v.color = read_rows(made.weighed.color.empty() ? present.color : made.weighed.color);
  v.neighbors = read_rows(made.rotated.empty() ? present.color : made.rotated);
  v.weight = read_rows(present.valid);
  v.motion = read_rows(present.motion.empty() ? made.at_rest : present.motion);
  v.sample_weight = read_rows(made.weighed.sample_weight);
  v.radius = rectify.window / 2;
  made.rows_valid.assign(std::size_t(w.height() + 2 * v.radius), 0);
  std::copy(present.rows_valid.begin(), present.rows_valid.end(), made.rows_valid.begin() + v.radius);
  v.rows_valid = made.rows_valid.data() + v.radius;
  return made;
}

void view_history(AccumulateView& v, const Present& present, const History& previous,
                  const RecursiveParameters& recursive) {
  const bool depth_test = recursive.disocclusion == Disocclusion::depth && !tests_depth_apart(recursive);
  if (previous.empty()) return;
  const Window &w = present.color.window(), &h = previous.color.window();
  v.history_width = h.width();
  v.history_height = h.height();
  v.shift_x = w.x0 - h.x0;
  v.shift_y = w.y0 - h.y0;
  v.history_color = read_rows(previous.color);
  v.history_total = read_rows(previous.total);
  v.history_spread = read_rows(previous.spread);
  v.history_rows_valid = previous.rows_valid.data();
  if (depth_test && !present.depth.empty() && !previous.depth.empty()) {
    v.depth = read_rows(present.depth);
    v.history_depth = read_rows(previous.depth);
  }
}

void view_diagnostics(AccumulateView& v, const Window& w, AccumulateDiagnostics& out, const DiagnosticsWanted& wanted) {
  if (wanted.clip) out.clip = Plane<float>(w);
  if (wanted.weight) out.weight = Plane<float>(w);
  if (wanted.reject) out.reject = Plane<std::uint32_t>(w);
  v.out_clip = write_rows(out.clip);
  v.out_weight = write_rows(out.weight);
  if (wanted.reject) v.out_reject = {out.reject.row(w.y0), out.reject.stride()};
}

void view_output(AccumulateView& v, Accumulated& out, const DiagnosticsWanted& wanted) {
  view_diagnostics(v, out.history.color.window(), out.diagnostics, wanted);
  v.out_color = write_rows(out.history.color);
  v.out_total = write_rows(out.history.total);
  v.out_spread = write_rows(out.history.spread);
  v.out_rows_valid = out.history.rows_valid.data();
}

void view_choices(AccumulateView& v, const RecursiveParameters& recursive, const RectifyParameters& rectify) {
  v.filter = recursive.history_filter;
  v.dering = recursive.dering;
  v.alpha_rule = recursive.alpha_rule;
  v.alpha = recursive.alpha;
  v.depth_tolerance = recursive.depth_tolerance;
  v.max_motion = 1e9;  // the decoder has made unusable vectors NaN; this only keeps positions inside an int
  v.box = rectify.box;
  v.rule = rectify.rule;
  v.anchor = rectify.anchor;
  v.space = rectify.space;
  v.gamma = rectify.gamma;
}

/// What stands between and after the steps of the kernel; null: nothing.
struct RowSteps {
  const RowPassView& passes;
  const RowPass* fetched = nullptr;
  const RowPass* rectified = nullptr;  ///< stands in place of the blend, and of what weighs it
  const CompanionPass* companions = nullptr;
};

void run_row(const AccumulateView& v, const RowSteps& steps, const RowKernel& kernel, int y, Scratch& scratch,
             int worker) {
  const RowPassView& passes = steps.passes;
  const RowScratch rows = scratch.view();
  const RowPassScratch extra = scratch.extra();
  kernel.fetch_history(v, y, rows);
  if (passes.tests_surfaces || passes.tests_vectors) test_history(passes, y, rows, extra);
  if (passes.weighs && passes.parameters.weight.anti_flicker > 0) find_clip_events(passes, y, rows, extra);
  if (steps.fetched) (*steps.fetched)(v, y, rows, worker);
  kernel.rectify_history(v, y, rows, scratch.counts);
  if (steps.rectified) {
    if (passes.tests_surfaces || passes.tests_vectors)
      for (int x = 0; x < v.width; ++x) rows.total[x] *= extra.trust[x];
    (*steps.rectified)(v, y, rows, worker);
  } else {
    if (passes.weighs) weigh_present(passes, y, rows, extra);
    kernel.blend_present(v, y, rows, scratch.counts);
    if (passes.finishes) finish_row(passes, y, rows, extra);
    if (steps.companions) accumulate_companions(v, y, rows, passes, *steps.companions);
  }
  count_bits(rows.reject, v.width, scratch.rejected);
}

AccumulateCounts run_rows(const AccumulateView& v, const RowSteps& steps, Isa isa, Workers& workers) {
  const RowKernel kernel = kernel_for(isa);
  std::vector<Scratch> scratch;
  for (int i = 0; i < workers.count(); ++i) scratch.emplace_back(v.width, steps.passes.weighs);
  constexpr int kBand = 8;  // rows: neighbors share what is in the cache
  workers.for_each(std::size_t((v.height + kBand - 1) / kBand), [&](std::size_t band, int worker) {
    const int end = std::min(v.height, int(band + 1) * kBand);
    for (int y = int(band) * kBand; y < end; ++y) run_row(v, steps, kernel, y, scratch[std::size_t(worker)], worker);
  });
  AccumulateCounts sum;
  for (const Scratch& s : scratch) {
    sum.restarted += s.counts.restarted;
    sum.clipped += s.counts.clipped;
    sum.vectors_bad += s.counts.vectors_bad;
    for (std::size_t bit = 0; bit < sum.rejected.size(); ++bit) sum.rejected[bit] += s.rejected[bit];
  }
  return sum;
}

}  // namespace

void remember_surfaces(History& history, const Present& present, const RecursiveParameters& p) {
  if (p.disocclusion == Disocclusion::depth && !present.depth.empty()) history.depth = present.depth.clone();
  if (p.reject.tests_vectors() && !present.motion.empty()) history.motion = present.motion.clone();
  if (p.reject.id != IdTest::off && !present.id.empty()) history.id = present.id.clone();
  if (p.reject.normal_angle > 0 && !present.normal.empty()) history.normal = present.normal.clone();
}

Accumulated accumulate(const Present& present, const History& previous, const RecursiveParameters& recursive,
                       const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, std::uint32_t restart_bit,
                       const DiagnosticsWanted& wanted, Workers& workers, Isa isa) {
  Accumulated out{make_history(present.color.window()), {}, {}};
  if (present.color.window().empty()) return out;
  AccumulateView v{};
  const PresentView made = view_present(v, present, rectify, recursive.sample_filter, jitter, workers);
  view_history(v, present, previous, recursive);
  // Companions are blended by the weight of the color.
  DiagnosticsWanted planes = wanted;
  planes.weight = wanted.weight || !present.companions.empty();
  view_output(v, out, planes);
  view_choices(v, recursive, rectify);
  v.restart_bit = restart_bit;
  Reconstruct reconstruct;
  if (!present.companions.empty() && recursive.sample_filter != SampleFilter::none && jitter)
    reconstruct = [&](const Plane<glm::vec4>& samples) {
      Present like;  // the same samples count
      like.color = samples.clone();
      like.valid = present.valid.clone();
      return weigh_samples(like, recursive.sample_filter, *jitter, workers).color;
    };
  const RowPassView passes = row_passes_for(v, present, previous, recursive);
  const CompanionPass companions = view_companions(v, present, previous, reconstruct, out.history);
  out.counts = run_rows(v, {passes, nullptr, nullptr, companions.empty() ? nullptr : &companions}, isa, workers);
  if (!wanted.weight) out.diagnostics.weight = {};
  remember_surfaces(out.history, present, recursive);
  return out;
}

History predict(const Present& present, const History& previous, const RecursiveParameters& recursive,
                const RectifyParameters& rectify, Workers& workers) {
  Accumulated out{make_history(present.color.window()), {}, {}};
  if (present.color.window().empty()) return std::move(out.history);
  AccumulateView v{};
  const PresentView made = view_present(v, present, rectify, SampleFilter::none, {}, workers);
  view_history(v, present, previous, recursive);
  view_output(v, out, {});
  view_choices(v, recursive, rectify);
  v.anchor = BoxAnchor::mean;
  v.leave_present_out = true;
  // Only what tells whether there is a history; how it would have been weighed does not matter here.
  RowPassView passes = row_passes_for(v, present, previous, recursive);
  passes.finishes = false;
  run_rows(v, {passes}, Isa::automatic, workers);
  return std::move(out.history);
}

AccumulateCounts visit_history(const Present& present, const History& previous, const RecursiveParameters& recursive,
                               const RectifyParameters& rectify, std::optional<glm::dvec2> jitter,
                               std::uint32_t restart_bit, const DiagnosticsWanted& wanted,
                               AccumulateDiagnostics& diagnostics, const RowPass& fetched, const RowPass& rectified,
                               Workers& workers, Isa isa) {
  if (present.color.window().empty()) return {};
  AccumulateView v{};
  const PresentView made = view_present(v, present, rectify, recursive.sample_filter, jitter, workers);
  view_history(v, present, previous, recursive);
  view_diagnostics(v, present.color.window(), diagnostics, wanted);
  view_choices(v, recursive, rectify);
  v.restart_bit = restart_bit;
  const RowPassView passes = row_passes_for(v, present, previous, recursive);
  return run_rows(v, {passes, &fetched, &rectified}, isa, workers);
}

}  // namespace varve
