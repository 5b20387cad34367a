#include "stages/provenance.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "stages/state_file.h"

namespace varve {
namespace {

/// Whether the history of schedule[first] goes on from an earlier run.
bool goes_on(const std::vector<ScheduledFrame>& schedule, std::size_t first, const StateHead* before) {
  return before && first == 0 && !schedule[0].restart;
}

}  // namespace

std::vector<int> frame_numbers_used(const std::vector<ScheduledFrame>& schedule, std::size_t index,
                                    const FrameReach& reach, const StateHead* before) {
  const auto [first, last] = span_around(schedule, index, reach);
  std::vector<int> frames;
  if (goes_on(schedule, first, before))
    for (const UsedFrame& used : before->frames) frames.push_back(used.frame);
  for (std::size_t i = first; i <= last; ++i) frames.push_back(schedule[i].frame);
  return frames;
}

std::vector<UsedFrame> frames_used(const std::vector<ScheduledFrame>& schedule, std::size_t index,
                                   const FrameReach& reach, const StateHead* before, InputWatch& watch) {
  const auto [first, last] = span_around(schedule, index, reach);
  std::vector<UsedFrame> frames;
  if (goes_on(schedule, first, before)) frames = before->frames;
  for (std::size_t i = first; i <= last; ++i) frames.push_back({schedule[i].frame, print_of(watch, schedule[i].frame)});
  return frames;
}

Provenance provenance_of(const std::vector<UsedFrame>& used, const std::string& extra) {
  std::vector<int> frames;
  std::uint64_t print = kEmptyPrint;
  for (const UsedFrame& u : used) {
    frames.push_back(u.frame);
    print = add_to_print(add_to_print(print, std::uint64_t(std::int64_t(u.frame))), u.print);
  }
  std::array<char, 17> hex{};
  std::snprintf(hex.data(), hex.size(), "%016llx", static_cast<unsigned long long>(print));
  return {format_frame_list(frames), hex.data(), extra};
}

std::string extras_used(const ExtraSamples& extras, const std::vector<ScheduledFrame>& schedule, std::size_t index,
                        const FrameReach& reach) {
  const auto [first, last] = span_around(schedule, index, reach);
  std::vector<int> frames;
  std::string names;
  for (std::size_t i = first; i <= last; ++i)
    if (const std::string text = extra_files_text(extras, schedule[i].frame); !text.empty()) {
      frames.push_back(schedule[i].frame);
      names += text + ",";
    }
  if (names.empty()) return "";
  return std::to_string(std::count(names.begin(), names.end(), ',')) + " files of frames " + format_frame_list(frames) +
         ", " + hash_of(names);
}

}  // namespace varve
