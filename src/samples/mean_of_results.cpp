#include "samples/mean_of_results.h"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace varve {
namespace {

using Results = std::span<const Accumulated* const>;

/// One plane of every result; none where they have none.
template <class At>
auto planes_of(Results results, const At& at) {
  using Pixels = std::remove_cvref_t<decltype(at(*results.front()))>;
  std::vector<const Pixels*> planes;
  for (const Accumulated* result : results)
    if (!at(*result).empty()) planes.push_back(&at(*result));
  return planes;
}

/// Pixel by pixel `combine` of a plane of all results; empty where one has none.
template <class T, class At, class Combine>
Plane<T> combined(Results results, const At& at, Workers& workers, const Combine& combine) {
  const auto planes = planes_of(results, at);
  if (planes.size() < results.size()) return {};
  const Window& w = planes.front()->window();
  Plane<T> plane(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      auto value = combine.start;
      for (const auto* p : planes) value = combine.add(value, p->at(x, y));
      plane.at(x, y) = T(combine.finish(value, planes.size()));
    }
  });
  return plane;
}

struct Mean {
  double start = 0;
  double add(double sum, float value) const { return sum + double(value); }
  double finish(double sum, std::size_t n) const { return sum / double(n); }
};
struct Sum {
  double start = 0;
  double add(double sum, float value) const { return sum + double(value); }
  double finish(double sum, std::size_t) const { return sum; }
};
struct Any {
  std::uint32_t start = 0;
  std::uint32_t add(std::uint32_t bits, std::uint32_t value) const { return bits | value; }
  std::uint32_t finish(std::uint32_t bits, std::size_t) const { return bits; }
};

/// Color like planes: only results that have seen something count, unless none has.
template <class At>
Plane<glm::vec4> mean_plane(Results results, const At& at, Workers& workers) {
  const Window& w = results.front()->history.color.window();
  Plane<glm::vec4> mean(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::dvec4 seen(0), all(0);
      int count = 0;
      for (const Accumulated* result : results) {
        const glm::dvec4 color(at(*result).at(x, y));
        all += color;
        if (!(result->history.total.at(x, y) > 0)) continue;
        seen += color;
        ++count;
      }
      mean.at(x, y) = glm::vec4(count > 0 ? seen / double(count) : all / double(results.size()));
    }
  });
  return mean;
}

void mean_history(Results results, History& out, Workers& workers) {
  const Window& w = results.front()->history.color.window();
  out.color = mean_plane(
      results, [](const Accumulated& a) -> const Plane<glm::vec4>& { return a.history.color; }, workers);
  for (std::size_t k = 0; k < results.front()->history.companions.size(); ++k)
    out.companions.push_back(mean_plane(
        results, [k](const Accumulated& a) -> const Plane<glm::vec4>& { return a.history.companions[k]; }, workers));
  out.total = Plane<float>(w);
  out.spread = Plane<float>(w);
  out.rows_valid = results.front()->history.rows_valid;
  for (const Accumulated* result : results)
    for (std::size_t row = 0; row < out.rows_valid.size(); ++row)
      out.rows_valid[row] = std::uint8_t(out.rows_valid[row] && result->history.rows_valid[row]);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      double total = 0, spread = 0;
      int count = 0;
      for (const Accumulated* result : results) {
        const History& h = result->history;
        if (!(h.total.at(x, y) > 0)) continue;
        total += double(h.total.at(x, y));
        spread += double(h.spread.at(x, y));
        ++count;
      }
      out.total.at(x, y) = float(total);
      out.spread.at(x, y) = count > 0 ? float(spread / (double(count) * count)) : 0.0f;
    }
  });
}

}  // namespace

Accumulated mean_of_results(Results results, Workers& workers) {
  Accumulated out;
  mean_history(results, out.history, workers);
  AccumulateDiagnostics& d = out.diagnostics;
  const auto of = [](auto member) {
    return [member](const Accumulated& a) -> const auto& { return a.diagnostics.*member; };
  };
  d.clip = combined<float>(results, of(&AccumulateDiagnostics::clip), workers, Mean{});
  d.blur = combined<float>(results, of(&AccumulateDiagnostics::blur), workers, Mean{});
  d.residual = combined<float>(results, of(&AccumulateDiagnostics::residual), workers, Mean{});
  d.weight = combined<float>(results, of(&AccumulateDiagnostics::weight), workers, Mean{});
  d.reject = combined<std::uint32_t>(results, of(&AccumulateDiagnostics::reject), workers, Any{});
  d.reject_future = combined<std::uint32_t>(results, of(&AccumulateDiagnostics::reject_future), workers, Any{});
  d.count_past = combined<float>(results, of(&AccumulateDiagnostics::count_past), workers, Sum{});
  d.count_future = combined<float>(results, of(&AccumulateDiagnostics::count_future), workers, Sum{});
  return out;
}

Plane<glm::vec4> mean_of_colors(std::span<const Plane<glm::vec4>* const> colors, Workers& workers) {
  const Window& w = colors.front()->window();
  Plane<glm::vec4> mean(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::dvec4 sum(0);
      for (const Plane<glm::vec4>* color : colors) sum += glm::dvec4(color->at(x, y));
      mean.at(x, y) = glm::vec4(sum / double(colors.size()));
    }
  });
  return mean;
}

}  // namespace varve
