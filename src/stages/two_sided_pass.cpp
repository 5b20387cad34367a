#include "stages/two_sided_pass.h"

#include <algorithm>
#include <utility>

namespace varve {

TwoSidedPass::TwoSidedPass(const std::vector<ScheduledFrame>& schedule, const FrameReach& reach,
                           const StepOptions& options, const std::string& spill_folder,
                           std::function<SourceFrame(std::size_t)> read, std::function<bool()> stop, Workers& workers)
    : schedule_(schedule),
      reach_(reach),
      options_(options),
      read_(std::move(read)),
      stop_(std::move(stop)),
      workers_(workers),
      futures_(spill_folder) {}

/// Finds the block of a frame, the ways through the past that serve it and the one after, and what its future says.
bool TwoSidedPass::start_block(std::size_t index) {
  const auto [first, last] = span_around(schedule_, index, reach_);
  const int start = block_start(schedule_[index].frame, reach_.block);
  const auto in_block = [&](std::size_t i) { return block_start(schedule_[i].frame, reach_.block) == start; };
  begin_ = end_ = index;
  while (begin_ > first && in_block(begin_ - 1)) --begin_;
  while (end_ <= last && in_block(end_)) ++end_;

  const auto serves = [&, begin = first](const std::optional<Past>& past) { return past && past->begin == begin; };
  if (!serves(past_)) past_ = serves(next_past_) ? std::move(next_past_) : Past{first, first, {Side::past, {}, {}}};
  next_past_.reset();
  // The block after begins its past with this one; where this one's past begins no earlier, they are the same.
  bool wanted_after = false;
  for (std::size_t i = end_; i <= last; ++i) wanted_after = wanted_after || is_wanted(i);
  if (wanted_after && first < begin_) next_past_ = Past{begin_, begin_, {Side::past, {}, {}}};
  return walk_back(last);
}

bool TwoSidedPass::walk_back(std::size_t last) {
  futures_.clear();
  forward_repairs_.clear();
  SideRun run{Side::future, {}, {}};
  for (std::size_t i = last + 1; i-- > begin_;) {
    if (stop_()) return false;
    SourceFrame source = read_(i);
    const SharedVectors vectors = take_vectors(source, options_.parameters.repair, workers_);
    std::vector<StrictSide> sides = pass_frame(run, source, vectors, options_, workers_);
    if (!(i < end_ && is_wanted(i))) continue;
    futures_.put(i, std::move(sides));
    forward_repairs_[i] = std::move(source.forward_repairs);
  }
  return true;
}

bool TwoSidedPass::advance_to(std::size_t index) {
  std::size_t from = past_->next;
  if (next_past_) from = std::min(from, next_past_->next);
  for (std::size_t i = from; i < index; ++i) {
    if (stop_()) return false;
    SourceFrame source = read_(i);
    const SharedVectors vectors = take_vectors(source, options_.parameters.repair, workers_);
    for (std::optional<Past>* past : {&past_, &next_past_})
      if (*past && (*past)->next == i) {
        pass_frame((*past)->run, source, vectors, options_, workers_);
        ++(*past)->next;
      }
  }
  return true;
}

std::optional<std::vector<Accumulated>> TwoSidedPass::resolve(std::size_t index, SourceFrame& source) {
  if (!(index >= begin_ && index < end_) && !start_block(index)) return std::nullopt;
  if (!advance_to(index)) return std::nullopt;
  const SharedVectors vectors = take_vectors(source, options_.parameters.repair, workers_);
  if (next_past_) {
    pass_frame(next_past_->run, source, vectors, options_, workers_);
    ++next_past_->next;
  }
  ++past_->next;
  if (const auto said = forward_repairs_.find(index); said != forward_repairs_.end())
    source.forward_repairs = std::move(said->second);
  return merge_frame(past_->run, source, vectors, futures_.take(index), options_, workers_);
}

}  // namespace varve
