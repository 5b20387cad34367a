#include "stages/accumulate_frame.h"

#include <algorithm>

#include "base/reject.h"
#include "resolve/accumulate.h"

namespace varve {
namespace {

std::uint32_t restart_bit(const ScheduledFrame& scheduled) {
  return scheduled.restart_reason == "first frame" ? kRejectFirstFrame : kRejectCut;
}

Resolved accumulate_one(const AccumulatorOptions& options, const Present& present, const ScheduledFrame& scheduled,
                        SubjectState& state, Workers& workers) {
  const Parameters& p = options.parameters;
  if (scheduled.restart) state.history = {};
  Resolved r;
  r.accumulated = accumulate(present, state.history, p.recursive, p.rectify, present.jitter, restart_bit(scheduled),
                             diagnostics_wanted(options.aovs), workers);
  const auto is_prediction = [](const Aov* aov) { return aov->name == "prediction"; };
  if (std::any_of(options.aovs.begin(), options.aovs.end(), is_prediction))
    r.prediction = predict(present, state.history, p.recursive, p.rectify, workers);
  return r;
}

/// Places among what is accumulated that make one result: samples meet in one pixel, everything else alone.
std::vector<std::vector<std::size_t>> resolved_together(const FrameHeaders& headers) {
  std::vector<std::vector<std::size_t>> groups;
  std::size_t next = 0;
  for (const ColorOutput& output : headers.outputs) {
    const std::size_t count = output.after ? output.inputs.size() : 1;
    for (std::size_t k = next; k < next + count; ++k)
      if (k > next && output.combine == Combine::samples)
        groups.back().push_back(k);
      else
        groups.push_back({k});
    next += count;
  }
  return groups;
}

}  // namespace

std::vector<Resolved> accumulate_recursive(const AccumulatorOptions& options, const SourceFrame& source,
                                           const ScheduledFrame& scheduled, std::vector<SubjectState>& states,
                                           Workers& workers) {
  std::vector<Resolved> resolved;
  for (std::size_t k = 0; k < source.presents.size(); ++k)
    resolved.push_back(accumulate_one(options, source.presents[k], scheduled, states[k], workers));
  return resolved;
}

std::vector<Resolved> accumulate_subpixel_frame(const AccumulatorOptions& options, const SourceFrame& source,
                                                const ScheduledFrame& scheduled, std::vector<SubjectState>& states,
                                                Workers& workers) {
  const Parameters& p = options.parameters;
  std::vector<Resolved> resolved(states.size());
  const std::vector<std::vector<std::size_t>> groups = resolved_together(source.headers);
  for (std::size_t output = 0; output < groups.size(); ++output) {
    const std::vector<std::size_t>& group = groups[output];
    SubpixelHistory& history = states[group.front()].subpixel;
    if (scheduled.restart) history = {};
    std::vector<const Present*> samples;
    for (const std::size_t k : group) samples.push_back(&source.presents[k]);
    if (output < source.extras.size())
      for (const Present& further : source.extras[output]) samples.push_back(&further);
    SubpixelStep step = accumulate_subpixel(samples, std::move(history), p.subpixel, p.recursive, p.rectify,
                                            options.blur_table ? &*options.blur_table : nullptr, restart_bit(scheduled),
                                            diagnostics_wanted(options.aovs), workers);
    history = std::move(step.history);
    resolved[group.front()].accumulated = std::move(step.resolved);
    resolved[group.front()].quarters = std::move(step.quarters);
  }
  return resolved;
}

std::vector<Resolved> accumulate_two_sided(TwoSidedPass& pass, std::size_t index, SourceFrame& source) {
  std::vector<Resolved> resolved;
  if (std::optional<std::vector<Accumulated>> all = pass.resolve(index, source))
    for (Accumulated& accumulated : *all) resolved.push_back({std::move(accumulated)});
  return resolved;
}

std::vector<Resolved> accumulate_gather(const AccumulatorOptions& options, FrameWindow& window, std::size_t index,
                                        std::pair<std::size_t, std::size_t> span, std::vector<SubjectState>& states,
                                        Workers& workers) {
  std::vector<Resolved> resolved(states.size());
  std::vector<MotionRepair>& repairs = window[index].repairs;
  repairs.clear();
  window[index].forward_repairs.clear();
  repairs.resize(states.size());
  const std::vector<std::vector<std::size_t>> groups = resolved_together(window[index].headers);
  for (std::size_t output = 0; output < groups.size(); ++output) {
    const std::vector<std::size_t>& group = groups[output];
    std::vector<GatherMemory>& memory = states[group.front()].gathered;
    resolved[group.front()].accumulated =
        gather_frame(window, output, group, index, span.first, span.second, options.gather, options.parameters.repair,
                     memory, diagnostics_wanted(options.aovs), workers);
    for (std::size_t k = 0; k < group.size(); ++k) {
      repairs[group[k]] = std::move(memory[k][index].backward_said);
      window[index].forward_repairs.push_back(std::move(memory[k][index].forward_said));
    }
  }
  return resolved;
}

}  // namespace varve
