#include "exr/jitter.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "base/words.h"

namespace varve {
namespace {

constexpr std::uintmax_t kMaxSidecarBytes = std::uintmax_t(64) << 20;  // a million frames need a third of it

// A sample one whole pixel away cannot belong to the pixel, so more than that is another unit or another thing.
// Written so that NaN fails.
bool within_a_pixel(const Jitter& jitter) { return std::abs(jitter.x) <= 1 && std::abs(jitter.y) <= 1; }

template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars knows no plus
  Number value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads the sidecar line by line; knows where it is, for messages.
struct SidecarReader {
  const std::string& path;
  JitterSource& source;
  int line = 0;
  bool has_header = false, has_samples = false;

  [[noreturn]] void refuse(const std::string& why) const {
    throw Failure(ExitCode::input, path + ":" + std::to_string(line) + ": " + why);
  }

  void header(const std::vector<std::string_view>& fields) {
    using Names = std::vector<std::string_view>;
    has_samples = fields == Names{"frame", "sample", "jx", "jy"};
    has_header = has_samples || fields == Names{"frame", "jx", "jy"};
    if (!has_header) refuse("the first line must be the header \"frame,jx,jy\" or \"frame,sample,jx,jy\"");
  }

  void row(const std::vector<std::string_view>& fields) {
    if (fields.size() != (has_samples ? 4u : 3u))
      refuse("has " + std::to_string(fields.size()) + " fields, but the header names " + (has_samples ? "4" : "3"));
    const std::optional<int> frame = whole_number<int>(fields[0]);
    const std::optional<int> sample = has_samples ? whole_number<int>(fields[1]) : std::optional<int>(0);
    const std::optional<double> x = whole_number<double>(fields[fields.size() - 2]);
    const std::optional<double> y = whole_number<double>(fields.back());
    if (!frame || !sample || !x || !y) refuse("holds something that is not a number");
    if (!within_a_pixel({*x, *y}))
      refuse("the jitter of frame " + std::to_string(*frame) +
             " is more than one pixel; give sample position minus pixel center in pixels, y down");
    const bool fresh = *sample == 0 ? source.table.emplace(*frame, Jitter{*x, *y}).second
                                    : source.further.emplace(std::pair(*frame, *sample), Jitter{*x, *y}).second;
    if (!fresh)
      refuse("frame " + std::to_string(*frame) + (*sample == 0 ? "" : ", sample " + std::to_string(*sample)) +
             " is listed twice");
  }

  void read(std::istream& in) {
    for (std::string text; std::getline(in, text);) {
      ++line;
      std::string_view rest = text;
      if (line == 1 && rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark of some editors
      rest = trimmed(rest);
      if (rest.empty() || rest.starts_with('#')) continue;
      if (has_header)
        row(split_at_commas(rest));
      else
        header(split_at_commas(rest));
    }
  }
};

JitterSource read_sidecar(const std::string& path) {
  std::error_code problem;
  const std::uintmax_t bytes = std::filesystem::file_size(path, problem);
  std::ifstream in(path, std::ios::binary);
  if (problem || !in)
    throw Failure(ExitCode::input,
                  path + ": the jitter file cannot be read; --jitter takes auto, none, a pattern or a CSV file");
  if (bytes > kMaxSidecarBytes)
    throw Failure(ExitCode::input, path + ": is too large for a jitter file (more than 64 MiB)");
  JitterSource source;
  source.kind = JitterSource::Kind::table;
  SidecarReader reader{path, source};
  reader.read(in);
  if (in.bad()) throw Failure(ExitCode::input, path + ": the jitter file cannot be read to its end");
  if (source.table.empty())
    throw Failure(ExitCode::input,
                  path + ": holds no jitter; it needs the header \"frame,jx,jy\" and a line for each frame");
  source.by_sample = reader.has_samples;
  source.description = path + (reader.has_samples ? " (several samples in a frame: sample 0 is taken)" : "");
  return source;
}

JitterSource pattern_source(const NamedPattern& named) {
  JitterSource source;
  source.kind = JitterSource::Kind::pattern;
  source.pattern = named.pattern;
  PatternRequest request;
  if (named.length > 0) request.length = named.length;
  source.points = named.pattern->points(request);
  source.description = "pattern " + std::string(named.pattern->name) + ", " + std::to_string(source.points.size()) +
                       (source.points.size() == 1 ? " point" : " points") + ", frame 1 is the first";
  return source;
}

std::optional<Jitter> jitter_in_header(const Part& part) {
  for (const Attribute& attribute : part.attributes)
    if (attribute.name == "jitter" && attribute.type == "v2f" && attribute.numbers.size() == 2)
      return Jitter{attribute.numbers[0], attribute.numbers[1]};
  for (const Attribute& attribute : part.attributes) {
    if (attribute.name != "Note" || attribute.type != "string") continue;
    const std::optional<JsonValue> note = parse_json(attribute.text);
    const JsonValue* member = note ? note->find("jitter") : nullptr;
    const std::optional<std::vector<double>> pair = member ? member->numbers() : std::nullopt;
    if (pair && pair->size() == 2) return Jitter{(*pair)[0], (*pair)[1]};
  }
  return std::nullopt;
}

}  // namespace

JitterSource parse_jitter_source(const std::string& text) {
  if (text == "auto") return {};
  if (text.starts_with("auto,")) {
    const std::optional<NamedPattern> named = parse_pattern(std::string_view(text).substr(5));
    if (!named)
      throw Failure(ExitCode::usage, "--assume-jitter " + text.substr(5) + ": unknown; see varve help patterns");
    JitterSource source = pattern_source(*named);
    source.kind = JitterSource::Kind::automatic;
    return source;
  }
  JitterSource source;
  source.kind = JitterSource::Kind::none;
  if (text == "none") return source;
  if (text == "pixels") {
    source.kind = JitterSource::Kind::pixels;
    source.description = "to be measured in the pixels";
    return source;
  }
  if (const std::optional<NamedPattern> named = parse_pattern(text)) return pattern_source(*named);
  std::error_code ignored;
  const bool looks_like_file = text.find_first_of("./") != std::string::npos || std::filesystem::exists(text, ignored);
  if (!looks_like_file)
    throw Failure(
        ExitCode::usage,
        "--jitter " + text +
            ": unknown; it takes auto, none, pixels, a CSV file, or a pattern such as halton23:16 (see varve help "
            "patterns)");
  return read_sidecar(text);
}

JitterSource with_samples(JitterSource source, int samples) {
  // A pattern that has so many points and no more goes round in them; the others get longer.
  if (source.kind != JitterSource::Kind::pattern || source.pattern->length > 0) return source;
  const std::int64_t length = std::int64_t(source.points.size()) * samples;
  if (length > source.pattern->most)
    throw Failure(ExitCode::usage, "a jitter of " + std::to_string(source.points.size()) + " frames with " +
                                       std::to_string(samples) + " samples each is too long; " +
                                       std::string(source.pattern->name) + " has up to " +
                                       std::to_string(source.pattern->most) + " points");
  PatternRequest request;
  request.length = int(length);
  source.points = source.pattern->points(request);
  return source;
}

Jitter pattern_point(std::span<const Jitter> points, int frame) {
  const auto n = std::int64_t(points.size());
  const std::int64_t turn = (std::int64_t(frame) - 1) % n;
  return points[std::size_t(turn < 0 ? turn + n : turn)];
}

std::optional<Jitter> jitter_of(const JitterSource& source, const Part& part, int frame) {
  switch (source.kind) {
    case JitterSource::Kind::none:
    case JitterSource::Kind::pixels:
      return std::nullopt;
    case JitterSource::Kind::pattern:
      return pattern_point(source.points, frame);
    case JitterSource::Kind::table: {
      const auto found = source.table.find(frame);
      return found == source.table.end() ? std::nullopt : std::optional<Jitter>(found->second);
    }
    case JitterSource::Kind::automatic:
      break;
  }
  const std::optional<Jitter> jitter = jitter_in_header(part);
  if (!jitter && !source.points.empty()) return pattern_point(source.points, frame);
  if (jitter && !within_a_pixel(*jitter))
    throw Failure(ExitCode::inconsistent,
                  "frame " + std::to_string(frame) + ": the jitter in the header" +
                      (part.name.empty() ? "" : " of part \"" + part.name + "\"") +
                      " is more than one pixel or not a number; give the jitter with --jitter FILE, or --jitter none");
  return jitter;
}

std::optional<Jitter> jitter_of_sample(const JitterSource& source, const Part& part, int frame, int sample,
                                       int samples) {
  if (samples == 1) return jitter_of(source, part, frame);
  if (source.kind == JitterSource::Kind::pattern) {
    // In turns of whole frames: the length counts points, so many of them for each frame.
    const auto turns = std::max<std::int64_t>(1, std::int64_t(source.points.size()) / samples);
    const std::int64_t turn = ((std::int64_t(frame) - 1) % turns + turns) % turns;
    return source.points[std::size_t((turn * samples + sample) % std::int64_t(source.points.size()))];
  }
  if (source.kind != JitterSource::Kind::table) return jitter_of(source, part, frame);
  if (!source.by_sample) return std::nullopt;
  if (sample == 0) return jitter_of(source, part, frame);
  const auto found = source.further.find({frame, sample});
  return found == source.further.end() ? std::nullopt : std::optional<Jitter>(found->second);
}

}  // namespace varve
