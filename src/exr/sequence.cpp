#include "exr/sequence.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>

#include "base/error.h"
#include "base/words.h"

namespace varve {
namespace {

constexpr int kMaxDigits = 16;
constexpr std::int64_t kMaxFrames = 10'000'000;  // a decade of film; more is a slip of the keyboard

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// A placeholder found in a name: where it lies and how wide its numbers are.
struct Placeholder {
  std::size_t begin = 0, end = 0;
  std::int64_t digits = 0;
};

// Digits from `at` on; `end` is moved past them. Saturates, so that absurd widths are refused and not wrapped.
std::int64_t read_width(std::string_view text, std::size_t at, std::size_t& end) {
  std::int64_t width = 0;
  for (end = at; end < text.size() && is_digit(text[end]); ++end)
    width = std::min<std::int64_t>(width * 10 + (text[end] - '0'), 1'000'000);
  return width;
}

// The placeholder that begins exactly at `at`, if there is one.
std::optional<Placeholder> placeholder_at(std::string_view text, std::size_t at) {
  const char c = text[at];
  std::size_t end = at + 1;
  if (c == '#' || c == '@') {
    while (end < text.size() && text[end] == c) ++end;
    const std::int64_t count = std::int64_t(end - at);
    return Placeholder{at, end, c == '#' && count == 1 ? 4 : count};
  }
  if (c == '%') {  // %d, %04d; %4d is read as %04d, for no file name is padded with blanks
    const std::int64_t width = read_width(text, at + 1, end);
    if (end < text.size() && text[end] == 'd') return Placeholder{at, end + 1, std::max<std::int64_t>(width, 1)};
  }
  if (c == '$' && end < text.size() && text[end] == 'F') {
    const std::int64_t width = read_width(text, at + 2, end);
    if (end < text.size() && is_letter(text[end])) return std::nullopt;  // another variable: $FF, $FSTART
    return Placeholder{at, end, std::max<std::int64_t>(width, 1)};
  }
  return std::nullopt;
}

std::optional<Placeholder> last_placeholder(std::string_view text) {
  const std::size_t slash = text.rfind('/');
  std::optional<Placeholder> last;
  for (std::size_t i = slash == std::string_view::npos ? 0 : slash + 1; i < text.size();) {
    const std::optional<Placeholder> here = placeholder_at(text, i);
    if (here) last = here;
    i = here ? here->end : i + 1;
  }
  return last;
}

// The whole of `text` as a frame number.
std::optional<int> whole_int(std::string_view text) {
  int value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// first, first + step, ... up to last.
struct Range {
  std::int64_t first = 0, last = 0, step = 1;
  std::int64_t count() const { return (last - first) / step + 1; }
};

[[noreturn]] void refuse(std::string_view part, const std::string& why) {
  throw Failure(ExitCode::usage, "frame list: \"" + std::string(part) + "\" " + why +
                                     "; write frames as 7, ranges as 1-10 and steps as 1-10x2, with commas between");
}

Range parse_range(std::string_view part) {
  if (part.empty()) refuse(part, "is empty");
  // The dash that separates is the first one behind the first digit, so both ends may be negative.
  const std::size_t dash = part.find('-', 1);
  if (dash == std::string_view::npos) {
    const std::optional<int> frame = whole_int(part);
    if (!frame) refuse(part, "is not a frame number");
    return {*frame, *frame, 1};
  }
  const std::size_t cross = part.find('x', dash);
  const std::optional<int> first = whole_int(part.substr(0, dash));
  const std::optional<int> last =
      whole_int(part.substr(dash + 1, cross == std::string_view::npos ? cross : cross - dash - 1));
  std::optional<int> step = 1;
  if (cross != std::string_view::npos) step = whole_int(part.substr(cross + 1));
  if (!first || !last || !step) refuse(part, "is not a range of frames");
  if (*step < 1) refuse(part, "has a step below 1");
  if (*last < *first) refuse(part, "runs backward");
  return {*first, *last, *step};
}

}  // namespace

SequencePattern SequencePattern::parse(std::string_view text) {
  if (text.empty()) throw Failure(ExitCode::usage, "a file name is empty; give a name such as shot.####.exr");
  if (text.find('\0') != std::string_view::npos)
    throw Failure(ExitCode::usage, "a file name holds a zero byte; give a name such as shot.####.exr");
  SequencePattern pattern;
  pattern.text_ = text;
  const std::optional<Placeholder> place = last_placeholder(text);
  if (!place) return pattern;
  if (place->digits > kMaxDigits)
    throw Failure(ExitCode::usage, std::string(text) +
                                       ": the frame number is padded to more than 16 digits; "
                                       "use at most 16, such as shot.####.exr");
  pattern.before_ = text.substr(0, place->begin);
  pattern.after_ = text.substr(place->end);
  pattern.digits_ = int(place->digits);
  pattern.has_frame_ = true;
  return pattern;
}

std::string SequencePattern::path(int frame) const {
  if (!has_frame_) return text_;
  const std::string digits = std::to_string(std::abs(std::int64_t(frame)));
  const std::size_t zeros = std::size_t(std::max(0, digits_ - int(digits.size())));
  return before_ + (frame < 0 ? "-" : "") + std::string(zeros, '0') + digits + after_;
}

std::vector<int> SequencePattern::frames_on_disk() const {
  namespace fs = std::filesystem;
  std::vector<int> frames;
  std::error_code problem;
  if (!has_frame_) {
    if (fs::exists(text_, problem)) frames.push_back(1);
    return frames;
  }
  const std::size_t slash = before_.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : before_.substr(0, slash + 1);
  const std::string_view prefix = std::string_view(before_).substr(slash == std::string::npos ? 0 : slash + 1);
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= prefix.size() + after_.size() || !name.starts_with(prefix) || !name.ends_with(after_)) continue;
    const std::optional<int> frame =
        whole_int(std::string_view(name).substr(prefix.size(), name.size() - prefix.size() - after_.size()));
    // Only the spelling that path() gives is the file that would be opened later.
    if (!frame || path(*frame) != before_ + name.substr(prefix.size())) continue;
    std::error_code ignored;
    if (!entry->is_directory(ignored)) frames.push_back(*frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::vector<int> parse_frame_list(std::string_view text) {
  std::vector<Range> ranges;
  std::int64_t total = 0;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const Range range = parse_range(trimmed(rest.substr(0, comma)));
    total += range.count();  // at most 2^32 a part, and refused at ten million: no overflow
    if (total > kMaxFrames) refuse(trimmed(rest.substr(0, comma)), "brings the list to more than ten million frames");
    ranges.push_back(range);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  std::vector<int> frames;
  frames.reserve(std::size_t(total));
  for (const Range& range : ranges)
    for (std::int64_t frame = range.first; frame <= range.last; frame += range.step) frames.push_back(int(frame));
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::string format_frame_list(const std::vector<int>& frames) {
  std::vector<int> sorted = frames;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::string text;
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i + 1;  // one behind the longest run of equal steps that begins at i
    const std::int64_t step = end < sorted.size() ? std::int64_t(sorted[end]) - sorted[i] : 1;
    while (end < sorted.size() && std::int64_t(sorted[end]) - sorted[end - 1] == step) ++end;
    // Two frames are no range, and three frames with a step read better one by one. A step must itself be an int.
    const bool run = end - i >= (step == 1 ? 3u : 4u) && step <= std::numeric_limits<int>::max();
    if (!text.empty()) text += ',';
    text += std::to_string(sorted[i]);
    if (run) text.append("-").append(std::to_string(sorted[end - 1]));
    if (run && step != 1) text.append("x").append(std::to_string(step));
    i = run ? end : i + 1;
  }
  return text;
}

}  // namespace varve
