#include "stages/comparison.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace varve {
namespace {

/// Frames have no limit on what is missing or not finite unless the user gives one.
std::vector<Limit> with_implied(std::vector<Limit> limits) {
  for (MetricId id : {MetricId::missing, MetricId::not_finite})
    if (std::ranges::none_of(limits, [id](const Limit& l) { return l.metric == id && l.fail; }))
      limits.push_back({id, 0, true});
  return limits;
}

bool applies(const Limit& limit, const ComparisonRow& row) {
  if (row.color) return true;
  constexpr MetricId of_channels[] = {MetricId::not_finite, MetricId::differing, MetricId::max, MetricId::mean,
                                      MetricId::rmse};
  return std::ranges::find(of_channels, limit.metric) != std::end(of_channels);
}

/// The frame that breaks it most; none breaks it: nothing is added.
void check_frames(Comparison& c, const Limit& limit, const ComparisonRow& row) {
  const bool down = metric_of(limit.metric).better == Better::down;
  LimitResult worst{limit, row.name, 0, true, 0};
  bool broken = false;
  for (std::size_t i = 0; i < row.frames.size(); ++i) {
    const double value = row.frames[i][limit.metric];
    const bool absent = std::isnan(row.frames[i][MetricId::differing]);  // the row is not in this frame
    if (absent || holds(limit, value)) continue;
    const bool worse = down ? value > worst.value : value < worst.value;
    if (broken && !worse && !std::isnan(value)) continue;
    worst.frame = c.frames[i];
    worst.value = value;
    broken = true;
    if (std::isnan(value)) break;
  }
  if (broken) c.broken.push_back(worst);
}

void check_limits(Comparison& c, const std::vector<Limit>& limits) {
  for (const Limit& limit : limits) {
    if (limit.metric == MetricId::missing) {
      const double missing = double(c.only_a.size() + c.only_b.size());
      if (!holds(limit, missing)) c.broken.push_back({limit, "", 0, false, missing});
      continue;
    }
    bool measured_somewhere = false;
    for (const ComparisonRow& row : c.rows) {
      if (!applies(limit, row)) continue;
      measured_somewhere = true;
      if (metric_of(limit.metric).scope == MetricScope::frame)
        check_frames(c, limit, row);
      else if (!holds(limit, row.sequence[limit.metric]))
        c.broken.push_back({limit, row.name, 0, false, row.sequence[limit.metric]});
    }
    if (!measured_somewhere) c.broken.push_back({limit, "", 0, false, std::nan("")});
  }
}

/// Larger is worse: what a viewer notices if it was measured, else the squared error.
double badness(const ComparisonRow& row, std::size_t frame) {
  const MetricValues& v = row.frames[frame];
  for (MetricId id : {MetricId::hdr_flip, MetricId::flip, MetricId::rmse})
    if (std::isfinite(v[id])) return v[id];
  return 0;
}

}  // namespace

void judge(Comparison& c, const std::vector<Limit>& limits) {
  if (!c.reason.empty()) {
    c.verdict = Verdict::incomparable;
    return;
  }
  bool equal = c.only_a.empty() && c.only_b.empty(), shape = false;
  for (const FrameFinding& found : c.findings) {
    equal = equal && found.finding.kind == FindingKind::note;
    shape = shape || found.finding.kind == FindingKind::shape;
  }
  // Written so that NaN is a difference.
  for (const ComparisonRow& row : c.rows) equal = equal && row.sequence[MetricId::differing] == 0;
  if (!c.rows.empty()) {
    c.worst.resize(c.frames.size());
    std::iota(c.worst.begin(), c.worst.end(), std::size_t(0));
    std::ranges::stable_sort(
        c.worst, [&](std::size_t i, std::size_t j) { return badness(c.rows.front(), i) > badness(c.rows.front(), j); });
    c.worst.resize(std::min<std::size_t>(3, c.worst.size()));
  }
  if (equal) {
    c.verdict = Verdict::equal;
    return;
  }
  check_limits(c, with_implied(limits));
  const bool has_limit = std::ranges::any_of(limits, [](const Limit& l) { return l.fail; });
  const bool broken = std::ranges::any_of(c.broken, [](const LimitResult& r) { return r.limit.fail; });
  c.verdict = has_limit && !broken && !shape ? Verdict::within : Verdict::beyond;
}

}  // namespace varve
