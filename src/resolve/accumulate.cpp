#include "resolve/accumulate.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "resolve/accumulate_row.h"
#include "resolve/bspline.h"
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

/// Degree of an interpolating B-spline, 0 for other filters.
int spline_degree(HistoryFilter filter) {
  return filter == HistoryFilter::bspline3 ? 3 : filter == HistoryFilter::bspline5 ? 5 : 0;
}

RowKernel kernel_for(Isa isa, HistoryFilter filter) {
  RowKernel kernel{baseline::fetch_history, baseline::rectify_history, baseline::blend_present};
#ifdef VARVE_HAVE_AVX2
  if (isa != Isa::baseline && __builtin_cpu_supports("avx2"))
    kernel = {avx2::fetch_history, avx2::rectify_history, avx2::blend_present};
#endif
  (void)isa;
  if (filter == HistoryFilter::cubic || spline_degree(filter) > 0) kernel.fetch_history = spline::fetch_history;
  return kernel;
}

/// Row buffers of one worker.
struct Scratch {
  Plane<glm::vec4> history;
  Plane<float> total, spread;
  Plane<std::uint32_t> reject;

  explicit Scratch(int width)
      : history(Window{0, 0, width, 1}),
        total(Window{0, 0, width, 1}),
        spread(Window{0, 0, width, 1}),
        reject(Window{0, 0, width, 1}) {}
  RowScratch view() { return {floats(history), total.row(0), spread.row(0), reject.row(0)}; }
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
                         SampleFilter sample_filter, Unjitter unjitter, std::optional<glm::dvec2> jitter,
                         Workers& workers) {
  const Window& w = present.color.window();
  PresentView made;
  if (sample_filter != SampleFilter::none && jitter)
    made.weighed = weigh_samples(present, sample_filter, *jitter, workers);
  else if (unjitter == Unjitter::bilinear && jitter)
    made.weighed.color = unjitter_bilinear(present, *jitter, workers);
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

/// Gives back the plane of B-spline coefficients that the view points to, where the filter needs one.
Plane<glm::vec4> view_history(AccumulateView& v, const Present& present, const History& previous,
                              const RecursiveParameters& recursive, Workers& workers) {
  if (previous.empty()) return {};
  const Window &w = present.color.window(), &h = previous.color.window();
  v.history_width = h.width();
  v.history_height = h.height();
  v.shift_x = w.x0 - h.x0;
  v.shift_y = w.y0 - h.y0;
  v.history_color = read_rows(previous.color);
  v.history_total = read_rows(previous.total);
  v.history_spread = read_rows(previous.spread);
  v.history_rows_valid = previous.rows_valid.data();
  if (recursive.disocclusion == Disocclusion::depth && !present.depth.empty() && !previous.depth.empty()) {
    v.depth = read_rows(present.depth);
    v.history_depth = read_rows(previous.depth);
  }
  const int degree = spline_degree(recursive.history_filter);
  if (degree == 0) return {};
  Plane<glm::vec4> coefficients = bspline_coefficients(previous.color, degree, workers);
  v.history_spline = read_rows(coefficients);
  return coefficients;
}

void view_output(AccumulateView& v, Accumulated& out, const DiagnosticsWanted& wanted) {
  const Window& w = out.history.color.window();
  if (wanted.clip) out.diagnostics.clip = Plane<float>(w);
  if (wanted.weight) out.diagnostics.weight = Plane<float>(w);
  if (wanted.reject) out.diagnostics.reject = Plane<std::uint32_t>(w);
  v.out_color = write_rows(out.history.color);
  v.out_total = write_rows(out.history.total);
  v.out_spread = write_rows(out.history.spread);
  v.out_clip = write_rows(out.diagnostics.clip);
  v.out_weight = write_rows(out.diagnostics.weight);
  if (wanted.reject) v.out_reject = {out.diagnostics.reject.row(w.y0), out.diagnostics.reject.stride()};
  v.out_rows_valid = out.history.rows_valid.data();
}

void view_choices(AccumulateView& v, const RecursiveParameters& recursive, const RectifyParameters& rectify) {
  v.filter = recursive.history_filter;
  v.cubic_b = recursive.cubic_b;
  v.cubic_c = recursive.cubic_c;
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

AccumulateCounts run_rows(const AccumulateView& v, Isa isa, Workers& workers) {
  const RowKernel kernel = kernel_for(isa, v.filter);
  std::vector<Scratch> scratch;
  for (int i = 0; i < workers.count(); ++i) scratch.emplace_back(v.width);
  std::vector<RowCounts> counts(std::size_t(workers.count()));
  constexpr int kBand = 8;  // rows: neighbors share what is in the cache
  workers.for_each(std::size_t((v.height + kBand - 1) / kBand), [&](std::size_t band, int worker) {
    const RowScratch rows = scratch[std::size_t(worker)].view();
    const int end = std::min(v.height, int(band + 1) * kBand);
    for (int y = int(band) * kBand; y < end; ++y) {
      kernel.fetch_history(v, y, rows);
      kernel.rectify_history(v, y, rows, counts[std::size_t(worker)]);
      kernel.blend_present(v, y, rows, counts[std::size_t(worker)]);
    }
  });
  AccumulateCounts sum;
  for (const RowCounts& c : counts) {
    sum.restarted += c.restarted;
    sum.clipped += c.clipped;
    sum.vectors_bad += c.vectors_bad;
  }
  return sum;
}

}  // namespace

Accumulated accumulate(const Present& present, const History& previous, const RecursiveParameters& recursive,
                       const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, std::uint32_t restart_bit,
                       const DiagnosticsWanted& wanted, Workers& workers, Isa isa) {
  Accumulated out{make_history(present.color.window()), {}, {}};
  if (present.color.window().empty()) return out;
  AccumulateView v{};
  const PresentView made =
      view_present(v, present, rectify, recursive.sample_filter, recursive.unjitter, jitter, workers);
  const Plane<glm::vec4> spline = view_history(v, present, previous, recursive, workers);
  view_output(v, out, wanted);
  view_choices(v, recursive, rectify);
  v.restart_bit = restart_bit;
  out.counts = run_rows(v, isa, workers);
  if (recursive.disocclusion == Disocclusion::depth && !present.depth.empty())
    out.history.depth = present.depth.clone();
  return out;
}

History predict(const Present& present, const History& previous, const RecursiveParameters& recursive,
                const RectifyParameters& rectify, Workers& workers) {
  Accumulated out{make_history(present.color.window()), {}, {}};
  if (present.color.window().empty()) return std::move(out.history);
  AccumulateView v{};
  const PresentView made = view_present(v, present, rectify, SampleFilter::none, Unjitter::none, {}, workers);
  const Plane<glm::vec4> spline = view_history(v, present, previous, recursive, workers);
  view_output(v, out, {});
  view_choices(v, recursive, rectify);
  v.anchor = BoxAnchor::mean;
  v.leave_present_out = true;
  run_rows(v, Isa::automatic, workers);
  return std::move(out.history);
}

}  // namespace varve
