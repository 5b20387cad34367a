#include "resolve/accumulate.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "resolve/accumulate_companions.h"
#include "resolve/accumulate_row.h"
#include "resolve/box_space.h"
#include "resolve/bspline.h"
#include "resolve/empty_spans.h"
#include "resolve/rectify_shapes.h"
#include "resolve/remainder.h"
#include "resolve/residual.h"
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
  Plane<float> trust, steadiness;
  Plane<double> present_weight;
  std::vector<Span> spans;
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
  WeighedPresent weighed;     // what is blended in where samples are weighed by their position
  BoxSpaceMap space;          // of the box
  Plane<glm::vec4> in_space;  // the neighborhood in the space of the box
  Plane<glm::vec2> at_rest;   // without vectors every pixel stays where it is
  std::vector<std::uint8_t> rows_valid;
  bool reconstructed = false;  // at the pixel centers, before
};

PresentView view_present(AccumulateView& v, const Present& present, const RectifyParameters& rectify,
                         SampleFilter sample_filter, Unjitter unjitter, std::optional<glm::dvec2> jitter,
                         Workers& workers) {
  const Window& w = present.color.window();
  PresentView made;
  made.reconstructed = sample_filter != SampleFilter::none && !present.reconstructed.empty();
  if (sample_filter != SampleFilter::none && jitter && !made.reconstructed)
    made.weighed = weigh_samples(present, sample_filter, *jitter, workers);
  else if (unjitter == Unjitter::bilinear && jitter)
    made.weighed.color = unjitter_bilinear(present, *jitter, workers);
  if (rectify.box != Box::none) {
    made.space = box_space_map(rectify.space, present, workers);
    made.in_space = plane_in_box_space(made.space, present.color, workers);
  }
  if (present.motion.empty()) made.at_rest = Plane<glm::vec2>(w, 0, glm::vec2(0.0f));

  v.width = w.width();
  v.height = w.height();
  v.color = read_rows(made.reconstructed           ? present.reconstructed
                      : made.weighed.color.empty() ? present.color
                                                   : made.weighed.color);
  v.neighbors = read_rows(made.in_space.empty() ? present.color : made.in_space);
  v.weight = read_rows(present.valid);
  v.motion = read_rows(present.motion.empty() ? made.at_rest : present.motion);
  v.sample_weight = read_rows(made.weighed.sample_weight.empty() ? present.sample_weight : made.weighed.sample_weight);
  v.radius = rectify.window / 2;
  made.rows_valid.assign(std::size_t(w.height() + 2 * v.radius), 0);
  std::copy(present.rows_valid.begin(), present.rows_valid.end(), made.rows_valid.begin() + v.radius);
  v.rows_valid = made.rows_valid.data() + v.radius;
  return made;
}

/// Gives back the plane of B-spline coefficients that the view points to, where the filter needs one.
Plane<glm::vec4> view_history(AccumulateView& v, const Present& present, const History& previous,
                              const RecursiveParameters& recursive, Workers& workers) {
  const bool depth_test = recursive.disocclusion == Disocclusion::depth && !tests_depth_apart(recursive);
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
  if (depth_test && !present.depth.empty() && !previous.depth.empty()) {
    v.depth = read_rows(present.depth);
    v.history_depth = read_rows(previous.depth);
  }
  const int degree = spline_degree(recursive.history_filter);
  if (degree == 0) return {};
  Plane<glm::vec4> coefficients = bspline_coefficients(previous.color, degree, workers);
  v.history_spline = read_rows(coefficients);
  return coefficients;
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

ShapeRules shape_rules(const RectifyParameters& rectify, const RecursiveParameters& recursive,
                       const PresentView& made) {
  return {rectify, made.space, recursive.alpha, made.weighed.color.empty() && !made.reconstructed};
}

/// What stands between and after the steps of the kernel; null: nothing.
struct RowSteps {
  const ShapeRules shapes;
  const RowPassView passes;
  const RowPass* fetched = nullptr;
  const RowPass* rectified = nullptr;  ///< stands in place of the blend, and of what weighs it
  const CompanionPass* companions = nullptr;
  Plane<glm::vec4>* remainder = nullptr;
};

/// Rows through the steps; what the row kernel has no code to rectify goes through the shapes instead.
class RowRunner {
 public:
  RowRunner(const AccumulateView& v, const RowSteps& steps, Isa isa, Workers& workers)
      : v_(v),
        steps_(steps),
        shapes_(needs_shapes(steps.shapes.rectify) ? &steps.shapes : nullptr),
        kernel_(kernel_for(isa, v.filter)),
        workers_(workers),
        room_(std::size_t(workers.count())) {
    for (int i = 0; i < workers.count(); ++i) scratch_.emplace_back(v.width, steps.passes.weighs);
  }

  AccumulateCounts all_rows() {
    if (may_skip()) empty_ = find_empty_blocks(v_, workers_);
    if (!shapes_) {
      run(0, v_.height);
    } else {
      prepare_frame(v_, *shapes_, contents_, workers_);
      const int rows = band_rows(*shapes_, v_.height);
      for (int begin = 0; begin < v_.height; begin += rows) {
        const int end = std::min(v_.height, begin + rows);
        prepare_band(v_, *shapes_, begin, end, contents_, workers_);
        run(begin, end);
      }
    }
    return sum_of_counts();
  }

 private:
  void run(int begin, int end) {
    constexpr int kBand = 8;  // rows: neighbors share what is in the cache
    workers_.for_each(std::size_t((end - begin + kBand - 1) / kBand), [&](std::size_t band, int worker) {
      const int first = begin + int(band) * kBand;
      for (int y = first; y < std::min(end, first + kBand); ++y) run_row(y, worker);
    });
  }

  /// Where a pixel at rest comes of itself alone, and nothing but the kernel looks at it, one may stand for many.
  bool may_skip() const {
    const RowPassView& p = steps_.passes;
    const bool reads_itself = v_.filter != HistoryFilter::cubic && spline_degree(v_.filter) == 0;
    const bool kernel_alone = !shapes_ && !steps_.fetched && !steps_.rectified && !steps_.companions &&
                              !steps_.remainder && !p.tests_surfaces && !p.tests_vectors && !p.weighs && !p.finishes;
    return reads_itself && kernel_alone && !v_.depth.origin && v_.history_width > 0 && !v_.leave_present_out;
  }

  void run_row(int y, int worker) {
    if (empty_.empty.empty()) return run_whole_row(y, worker);
    Scratch& scratch = scratch_[std::size_t(worker)];
    find_spans(v_, empty_, y, scratch.spans);
    if (scratch.spans.size() == 1 && !scratch.spans.front().empty) return run_whole_row(y, worker);
    bool valid = true;
    for (const Span& span : scratch.spans) {
      const AccumulateView view = view_span(v_, span);
      const RowScratch rows = scratch.view();
      kernel_.fetch_history(view, y, rows);
      kernel_.rectify_history(view, y, rows, scratch.counts);
      kernel_.blend_present(view, y, rows, scratch.counts);
      count_bits(rows.reject, view.width, scratch.rejected);
      if (span.empty) spread_first(v_, y, span);
      valid = valid && v_.out_rows_valid[y];
    }
    v_.out_rows_valid[y] = valid;
  }

  void run_whole_row(int y, int worker) {
    const RowPassView& passes = steps_.passes;
    Scratch& scratch = scratch_[std::size_t(worker)];
    const RowScratch rows = scratch.view();
    const RowPassScratch extra = scratch.extra();
    const bool tests = passes.tests_surfaces || passes.tests_vectors;
    kernel_.fetch_history(v_, y, rows);
    if (tests) test_history(passes, y, rows, extra);
    if (passes.weighs && passes.parameters.weight.anti_flicker > 0) find_clip_events(passes, y, rows, extra);
    if (steps_.fetched && *steps_.fetched) (*steps_.fetched)(v_, y, rows, worker);
    if (shapes_)
      rectify_shapes(v_, *shapes_, contents_, y, rows, room_[std::size_t(worker)], scratch.counts);
    else
      kernel_.rectify_history(v_, y, rows, scratch.counts);
    if (steps_.rectified) {
      for (int x = 0; tests && x < v_.width; ++x) rows.total[x] *= extra.trust[x];
      (*steps_.rectified)(v_, y, rows, worker);
    } else {
      if (passes.weighs) weigh_present(passes, y, rows, extra);
      kernel_.blend_present(v_, y, rows, scratch.counts);
      if (passes.finishes) finish_row(passes, y, rows, extra);
      if (steps_.remainder) blend_remainder(passes, y, rows, extra, *steps_.remainder);
      if (steps_.companions) accumulate_companions(v_, y, rows, passes, *steps_.companions);
    }
    count_bits(rows.reject, v_.width, scratch.rejected);
  }

  AccumulateCounts sum_of_counts() const {
    AccumulateCounts sum;
    for (const Scratch& s : scratch_) {
      sum.restarted += s.counts.restarted;
      sum.clipped += s.counts.clipped;
      sum.vectors_bad += s.counts.vectors_bad;
      for (std::size_t bit = 0; bit < sum.rejected.size(); ++bit) sum.rejected[bit] += s.rejected[bit];
    }
    return sum;
  }

  const AccumulateView& v_;
  const RowSteps& steps_;
  const ShapeRules* shapes_;
  RowKernel kernel_;
  Workers& workers_;
  WindowContents contents_;
  EmptyBlocks empty_;
  std::vector<Scratch> scratch_;
  std::vector<ShapeScratch> room_;
};

AccumulateCounts run_rows(const AccumulateView& v, const RowSteps& steps, Isa isa, Workers& workers) {
  return RowRunner(v, steps, isa, workers).all_rows();
}

}  // namespace

void remember_surfaces(History& history, const Present& present, const RecursiveParameters& p) {
  if (p.disocclusion == Disocclusion::depth && !present.depth.empty()) history.depth = present.depth.clone();
  if (p.reject.tests_vectors() && !present.motion.empty()) history.motion = present.motion.clone();
  if (p.reject.id != IdTest::off && !present.id.empty()) history.id = present.id.clone();
  if (p.reject.normal_angle > 0 && !present.normal.empty()) history.normal = present.normal.clone();
}

namespace {

/// The difference of present and history, before they are blended: one more walk through the rows.
Plane<float> find_residual(const Present& present, const History& previous, const RecursiveParameters& recursive,
                           const RectifyParameters& rectify, std::optional<glm::dvec2> jitter, Workers& workers,
                           Isa isa) {
  const Window& w = present.color.window();
  Plane<glm::vec4> differences(w);
  const auto compare = [&](const AccumulateView& v, int y, const RowScratch& s, int) {
    for (int x = 0; x < v.width; ++x) {
      const bool both = s.total[x] > 0 && v.weight.origin[y * v.weight.stride + x] > 0;
      const float* c = v.color.origin + y * v.color.stride + 4 * x;
      const float* h = s.history + 4 * x;
      differences.row(y + w.y0)[x] =
          both ? difference_to({c[0], c[1], c[2], c[3]}, {h[0], h[1], h[2], h[3]}) : glm::vec4(0.0f);
    }
  };
  AccumulateDiagnostics none;
  visit_history(present, previous, recursive, rectify, jitter, 0, {}, none, {}, compare, workers, isa);
  return residual_of(differences, recursive.residual_window, workers);
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
  // Companions are blended by the weight of the color.
  DiagnosticsWanted planes = wanted;
  planes.weight = wanted.weight || !present.companions.empty();
  view_output(v, out, planes);
  view_choices(v, recursive, rectify);
  v.restart_bit = restart_bit;
  Reconstruct reconstruct;
  const bool weighs = recursive.sample_filter != SampleFilter::none, moves = recursive.unjitter != Unjitter::none;
  if (!present.companions.empty() && (weighs || moves) && jitter)
    reconstruct = [&, weighs](const Plane<glm::vec4>& samples) {
      Present like;  // the same samples count
      like.color = samples.clone();
      like.valid = present.valid.clone();
      return weighs ? weigh_samples(like, recursive.sample_filter, *jitter, workers).color
                    : unjitter_bilinear(like, *jitter, workers);
    };
  const CompanionPass companions = view_companions(v, present, previous, reconstruct, out.history);
  // A first frame is what it is: there is nothing to round.
  if (keeps_remainder(recursive) && !previous.empty()) out.history.remainder = Plane<glm::vec4>(present.color.window());
  RowPassView passes = row_passes_for(v, present, previous, recursive);
  BoundPlanes bounds{{}, &out.history.blur};
  const bool compares = recursive.residual_limit > 0 || wanted.residual;
  if (recursive.bounds() || wanted.blur || compares) {
    if (compares) bounds.residual = find_residual(present, previous, recursive, rectify, jitter, workers, isa);
    out.history.blur = Plane<float>(present.color.window());
    passes.bounds = &bounds;
    passes.weighs = true;
  }
  out.counts = run_rows(
      v,
      {shape_rules(rectify, recursive, made), passes, nullptr, nullptr, companions.empty() ? nullptr : &companions,
       out.history.remainder.empty() ? nullptr : &out.history.remainder},
      isa, workers);
  if (wanted.blur) out.diagnostics.blur = out.history.blur.clone();
  if (wanted.residual) out.diagnostics.residual = std::move(bounds.residual);
  if (!wanted.weight) out.diagnostics.weight = {};
  remember_surfaces(out.history, present, recursive);
  return out;
}

History predict(const Present& present, const History& previous, const RecursiveParameters& recursive,
                const RectifyParameters& asked, Workers& workers) {
  RectifyParameters rectify = asked;
  rectify.anchor = BoxAnchor::mean;
  // What one pixel counts in a bell or a pyramid is not known afterwards; in the plain window of that size it is.
  if (rectify.moments != WindowMoments::direct) rectify.moments = WindowMoments::separable;
  Accumulated out{make_history(present.color.window()), {}, {}};
  if (present.color.window().empty()) return std::move(out.history);
  AccumulateView v{};
  const PresentView made = view_present(v, present, rectify, SampleFilter::none, Unjitter::none, {}, workers);
  const Plane<glm::vec4> spline = view_history(v, present, previous, recursive, workers);
  view_output(v, out, {});
  view_choices(v, recursive, rectify);
  v.leave_present_out = true;
  // Only what tells whether there is a history; how it would have been weighed does not matter here.
  RowPassView passes = row_passes_for(v, present, previous, recursive);
  passes.finishes = false;
  run_rows(v, {shape_rules(rectify, recursive, made), passes}, Isa::automatic, workers);
  return std::move(out.history);
}

AccumulateCounts visit_history(const Present& present, const History& previous, const RecursiveParameters& recursive,
                               const RectifyParameters& rectify, std::optional<glm::dvec2> jitter,
                               std::uint32_t restart_bit, const DiagnosticsWanted& wanted,
                               AccumulateDiagnostics& diagnostics, const RowPass& fetched, const RowPass& rectified,
                               Workers& workers, Isa isa) {
  if (present.color.window().empty()) return {};
  AccumulateView v{};
  const PresentView made =
      view_present(v, present, rectify, recursive.sample_filter, recursive.unjitter, jitter, workers);
  const Plane<glm::vec4> spline = view_history(v, present, previous, recursive, workers);
  view_diagnostics(v, present.color.window(), diagnostics, wanted);
  view_choices(v, recursive, rectify);
  v.restart_bit = restart_bit;
  return run_rows(
      v, {shape_rules(rectify, recursive, made), row_passes_for(v, present, previous, recursive), &fetched, &rectified},
      isa, workers);
}

}  // namespace varve
