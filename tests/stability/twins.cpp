#include "stability/twins.h"

#include <cmath>

#include "plan/knob_words.h"
#include "reference/accumulate_reference.h"
#include "reference/history_filter_reference.h"
#include "reference/two_sided_reference.h"
#include "resolve/bspline.h"
#include "resolve/sample_weights.h"
#include "resolve/two_sided.h"
#include "stability/passes.h"
#include "stability/twins_parts.h"

namespace varve::stability {
namespace {

std::vector<Input> inputs_for(bool thorough) {
  std::vector<Input> inputs;
  inputs.push_back({"noise", base_shot(kTwinWindow, Moves::any, 3, 40, true)});
  inputs.push_back({"pan", base_shot(kTwinWindow, Moves::pan, 3, 41, true)});
  // Neighbors at opposite ends of the floats come out finite (laws_test), and between their own neighbors, but not as
  // the twin has them: their differences are no floats.
  for (const Extreme& extreme : extremes())
    if (extreme.name.find("end of float") == std::string::npos &&
        extreme.name.find("ends of float") == std::string::npos &&
        (thorough || extreme.name == "values of all kinds" || extreme.name == "flat 60000"))
      inputs.push_back({extreme.name, extreme.make(kTwinWindow)});
  return inputs;
}

/// "accumulate box hull clip ..." -> "accumulate box hull": the family is what the first words say.
std::string family_of(const std::string& pass, int words) {
  std::size_t end = 0;
  for (int i = 0; i < words && end != std::string::npos; ++i) end = pass.find(' ', end + (end > 0));
  return pass.substr(0, end);
}

bool has_twin(const RecursiveParameters& p) {
  // The wide filters have a twin of their own, un-jittering as well.
  return p.history_filter != HistoryFilter::cubic && p.history_filter != HistoryFilter::bspline3 &&
         p.history_filter != HistoryFilter::bspline5 && p.unjitter == Unjitter::none;
}

/// Where pass and twin are known to part, and no bound is held:
/// a hull is widened by a millionth of its size, so that a segment which just misses a long thin one beside a highlight
/// leaves it much later than the exact one (hull_test has the bounds); the nearest point of a k-DOP or of a box along
/// principal axes that reaches from 1e30 to 1; axes of neighbors that spread alike in two directions, which are
/// anyone's (one sample of 65504 among nine makes such); tests of vectors where 1e-7 of a pixel decides which of four
/// pixels count.
bool is_open(const std::string& pass, const std::string& input) {
  if (pass.starts_with("accumulate box hull clip")) return true;
  const bool vast = input == "values 1e30" || input == "values of all kinds";
  if (vast && pass.starts_with("accumulate box kdop")) return true;
  const bool bright = input == "values negative" || input == "values 65504";
  if ((vast || bright) && pass.starts_with("accumulate box pca")) return true;
  return input == "vectors tiny" && (pass.starts_with("reject speed") || pass.starts_with("reject acceleration"));
}

void measure_recursive(const std::vector<Input>& inputs, bool thorough, std::vector<Measured>& rows, Workers& workers) {
  std::string last_family;
  for (const Pass& pass : resolve_passes()) {
    if (!pass.recursive || !has_twin(pass.recursive->recursive)) continue;
    const Settings& s = *pass.recursive;
    const std::string family = family_of(pass.name, 3);
    // One of a family will do where time is short, and the slowest oracles (bisection in a hull) on fewer inputs.
    if (!thorough && family == last_family) continue;
    last_family = family;
    // Clips by bisection and logarithms end within rounding of the face they end at.
    // What clips takes one way to the box for all channels: where a channel was moved by little more than rounding,
    // that way is known to little more than rounding. The box is never narrower than a millionth of the color, so a
    // step of float becomes a few thousandths of the width of the box at worst; in logarithms more, and with a
    // discount, which goes by the square of the way, more still.
    const bool clips = s.rectify.box != Box::none && s.rectify.rule == BoxRule::clip;
    const bool logs = s.rectify.space == BoxSpace::log || s.recursive.weight.weighing == Weighing::logarithm;
    const double bound = s.rectify.clip_discount ? 5e-2 : clips && logs ? 5e-3 : clips ? 1e-3 : logs ? 1e-4 : 5e-6;
    for (const Input& input : inputs) {
      const bool open = is_open(pass.name, input.name);
      Measured& row = row_of(rows, open ? family + " (open)" : family, words_of(inputs), open ? 1 : bound);
      row.bound = std::max(row.bound, open ? 1 : bound);
      ++row.runs;
      History history;
      for (const RawFrame& raw : input.shot) {
        const Present present = present_of(raw, workers);
        Accumulated fast = accumulate(present, history, s.recursive, s.rectify, raw.jitter, 1, {}, workers);
        const Window& w = present.color.window();
        each_pixel(w, [&](int x, int y) {
          const reference::Pixel slow =
              reference::accumulate_pixel(present, history, s.recursive, s.rectify, raw.jitter, 1, x, y);
          const double size = size_around(present, &history, x, y, std::max(3, s.rectify.window / 2 + 2));
          for (int k = 0; k < 4; ++k, ++row.values)
            row.take(double(fast.history.color.at(x, y)[k]) - slow.color[std::size_t(k)],
                     std::max(size, std::abs(slow.color[std::size_t(k)])), pass.name + ", " + input.name);
        });
        history = std::move(fast.history);
      }
    }
  }
}

void measure_filters(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers) {
  RectifyParameters open;
  open.box = Box::none;
  for (const Word<HistoryFilter>& filter : kHistoryFilters) {
    if (filter.value != HistoryFilter::cubic && filter.value != HistoryFilter::bspline3 &&
        filter.value != HistoryFilter::bspline5)
      continue;
    const int degree = filter.value == HistoryFilter::bspline3 ? 3 : 5;
    Measured& row = row_of(rows, "accumulate filter " + std::string(filter.word), words_of(inputs), 5e-6);
    for (const Input& input : inputs)
      for (const bool dering : {true, false}) {
        ++row.runs;
        RecursiveParameters p;
        p.history_filter = filter.value, p.dering = dering;
        const Present first = present_of(input.shot[0], workers), second = present_of(input.shot[1], workers);
        const History h = accumulate(first, {}, p, open, {}, 1, {}, workers).history;
        const History fast = predict(second, h, p, open, workers);
        Plane<glm::dvec4> solved;
        if (filter.value != HistoryFilter::cubic) solved = reference::solve_bspline(h.color, degree);
        const Window& w = h.color.window();
        const int reach = filter.value == HistoryFilter::bspline5 ? 2 : 1;
        each_pixel(w, [&](int x, int y) {
          const double px = x + double(second.motion.at(x, y).x), py = y + double(second.motion.at(x, y).y);
          if (!(std::abs(px) < 1000 && std::abs(py) < 1000)) return;
          const int bx = int(std::floor(px)), by = int(std::floor(py));
          for (int j = by - reach; j <= by + reach + 1; ++j)
            for (int i = bx - reach; i <= bx + reach + 1; ++i)
              if (!w.contains(i, j) || !(h.total.at(i, j) > 0)) return;
          // A spline hears of the whole line, fainter and fainter.
          const double size = size_around(first, &h, bx, by, filter.value == HistoryFilter::cubic ? 3 : 40);
          for (int k = 0; k < 4; ++k, ++row.values) {
            const double slow = filter.value == HistoryFilter::cubic
                                    ? reference::cubic_at(h.color, p.cubic_b, p.cubic_c, px, py, k, dering)
                                    : reference::bspline_at(solved, h.color, degree, px, py, k, dering);
            // Held at the ends of the floats, which the twin does not know.
            if (size > 1e36) continue;
            row.take(double(fast.color.at(x, y)[k]) - slow, size, std::string(filter.word) + ", " + input.name);
          }
        });
      }
  }
}

void measure_two_sided(const std::vector<Input>& inputs, bool thorough, std::vector<Measured>& rows, Workers& workers) {
  std::string last_family;
  for (const Pass& pass : resolve_passes()) {
    if (!pass.two_sided || !has_twin(pass.two_sided->recursive)) continue;
    const Settings& s = *pass.two_sided;
    const std::string family = family_of(pass.name, pass.name.starts_with("two-sided box") ? 3 : 2);
    if (!thorough && family == last_family) continue;
    last_family = family;
    // The discount divides by the square of how far history was moved: what rounding moved a little weighs otherwise.
    const bool open = s.rectify.box == Box::hull;
    Measured& row = row_of(rows, open ? family + " (open)" : family, words_of(inputs), open ? 1 : 1e-3);
    for (const Input& input : inputs) {
      ++row.runs;
      const auto& r = s.recursive;
      const RawFrame &a = input.shot[0], &b = input.shot[1], &c = input.shot[2];
      const Present before = present_of(a, workers), now = present_of(b, workers), turned = turned_present(b, workers),
                    after = turned_present(c, workers);
      const History past = accumulate_side(before, {}, r, s.rectify, a.jitter, 1, {}, workers).state;
      const History next = accumulate_side(after, {}, r, s.rectify, c.jitter, 1, {}, workers).state;
      const StrictSide future = accumulate_side(turned, next, r, s.rectify, b.jitter, 1, {}, workers).strict;
      const MergedStep fast = accumulate_both(now, past, future, r, s.rectify, b.jitter, 1, {}, workers);
      each_pixel(now.color.window(), [&](int x, int y) {
        const reference::SidePixel one = reference::side_pixel(now, past, r, s.rectify, b.jitter, 1, x, y);
        reference::Pixel other;
        for (int k = 0; k < 4; ++k) other.color[std::size_t(k)] = double(future.color.at(x, y)[k]);
        other.total = double(future.total.at(x, y)), other.spread = double(future.spread.at(x, y));
        const reference::Pixel slow = reference::merged_pixel(now, one.strict, other, r, b.jitter, x, y);
        const double size = std::max(size_around(now, &past, x, y, 4), size_around(after, nullptr, x, y, 6));
        for (int k = 0; k < 4; ++k, ++row.values)
          row.take(double(fast.resolved.history.color.at(x, y)[k]) - slow.color[std::size_t(k)], size,
                   pass.name + ", " + input.name);
      });
    }
  }
}

void measure_presents(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers) {
  Measured& mended = row_of(rows, "sanitize", words_of(inputs), 1e-7);
  Measured& weighed = row_of(rows, "weigh_samples", words_of(inputs) + ", 4 filters", 1e-6);
  Measured& moved = row_of(rows, "unjitter_bilinear", words_of(inputs), 1e-6);
  for (const Input& input : inputs)
    for (const RawFrame& raw : input.shot) {
      ++mended.runs, ++moved.runs;
      const Present p = present_of(raw, workers);
      const Plane<glm::vec4> centered = unjitter_bilinear(p, raw.jitter, workers);
      each_pixel(p.color.window(), [&](int x, int y) {
        const double size = size_around(p, nullptr, x, y, 3);
        if (!(p.valid.at(x, y) > 0)) {
          long double sum[4] = {0, 0, 0, 0};
          int n = 0;
          for (int j = y - 1; j <= y + 1; ++j)
            for (int i = x - 1; i <= x + 1; ++i)
              if (p.valid.at(i, j) > 0) {
                for (int k = 0; k < 4; ++k) sum[k] += static_cast<long double>(raw.color.at(i, j)[k]);
                ++n;
              }
          for (int k = 0; k < 4; ++k, ++mended.values)
            mended.take(double(p.color.at(x, y)[k]) - (n ? double(sum[k] / n) : 0.0), size, input.name);
        }
        const glm::dvec4 slow = reference::unjittered(p, raw.jitter, x, y);
        for (int k = 0; k < 4; ++k, ++moved.values)
          moved.take(double(centered.at(x, y)[k]) - slow[k], size, input.name);
      });
      for (const Word<SampleFilter>& filter : kSampleFilters) {
        if (filter.value == SampleFilter::none) continue;
        ++weighed.runs;
        const WeighedPresent fast = weigh_samples(p, filter.value, raw.jitter, workers);
        each_pixel(p.color.window(), [&](int x, int y) {
          double weight = 0;
          const reference::Color slow = reference::weighed_present(p, filter.value, raw.jitter, x, y, weight);
          // A sum near the tenth where the negative lobes are left out divides by little.
          const double size = size_around(p, nullptr, x, y, 3) * 4;
          for (int k = 0; k < 4; ++k, ++weighed.values)
            weighed.take(double(fast.color.at(x, y)[k]) - std::clamp(slow[std::size_t(k)], -3.4028235e38, 3.4028235e38),
                         size, std::string(filter.word) + ", " + input.name);
        });
      }
    }
}

}  // namespace

double size_around(const Present& present, const History* history, int x, int y, int reach) {
  double size = 1e-37;
  const Window& w = present.color.window();
  for (int j = std::max(y - reach, w.y0); j <= std::min(y + reach, w.y1 - 1); ++j)
    for (int i = std::max(x - reach, w.x0); i <= std::min(x + reach, w.x1 - 1); ++i)
      for (int k = 0; k < 4; ++k) {
        size = std::max(size, std::abs(double(present.color.at(i, j)[k])));
        if (history && !history->empty() && history->color.window().contains(i, j))
          size = std::max(size, std::abs(double(history->color.at(i, j)[k])));
      }
  return size;
}

std::string words_of(const std::vector<Input>& inputs) {
  return std::to_string(inputs.size()) + " shots of " + std::to_string(kTwinWindow.width()) + "x" +
         std::to_string(kTwinWindow.height());
}

Measured& row_of(std::vector<Measured>& rows, const std::string& family, const std::string& inputs, double bound) {
  for (Measured& row : rows)
    if (row.pass == family) return row;
  rows.push_back({family, inputs, 0, 0, 0, "", bound});
  return rows.back();
}

void Measured::take(double difference, double size, const std::string& pass_and_input) {
  const double relative = difference == 0 ? 0 : std::abs(difference) / size;
  if (relative <= worst) return;  // false for NaN, which stays the worst
  if (!(worst == worst)) return;
  worst = relative;
  where = pass_and_input;
}

std::vector<Measured> measure_twins(bool thorough, Workers& workers) {
  std::vector<Measured> rows;
  rows.reserve(200);  // rows are referred to while others are added
  const std::vector<Input> inputs = inputs_for(thorough);
  measure_presents(inputs, rows, workers);
  measure_recursive(inputs, thorough, rows, workers);
  measure_filters(inputs, rows, workers);
  measure_two_sided(inputs, thorough, rows, workers);
  measure_gather(thorough, rows, workers);
  measure_combining(inputs, rows, workers);
  measure_deep(thorough, rows);
  measure_motion(inputs, rows, workers);
  measure_moments(thorough, rows, workers);
  measure_metrics(inputs, rows, workers);
  return rows;
}

}  // namespace varve::stability
