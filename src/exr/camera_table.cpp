#include "exr/camera_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/json.h"
#include "base/words.h"

namespace varve {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t(64) << 20;  // a hundred thousand frames
constexpr const char* kForms =
    "give a CSV file with the header frame,v0,...,v15 and then p0,...,p15 or focal,aperture, or JSON with frame, view "
    "and proj or focal and aperture";

using Table = std::map<int, CameraRow>;

[[noreturn]] void refuse(const std::string& where, const std::string& why) {
  throw Failure(ExitCode::input, where + ": " + why);
}

void add(Table& table, const std::string& where, double frame, const CameraRow& row) {
  if (!(frame >= -2147483648.0 && frame <= 2147483647.0) || frame != std::floor(frame))
    refuse(where, "the frame is not a whole number");
  if (!table.emplace(int(frame), row).second) refuse(where, "frame " + std::to_string(int(frame)) + " is listed twice");
}

/// The names of v0..v15 or p0..p15.
std::vector<std::string> sixteen(char letter) {
  std::vector<std::string> names;
  for (int i = 0; i < 16; ++i) names.push_back(letter + std::to_string(i));
  return names;
}

std::vector<std::string> csv_header(bool projection) {
  std::vector<std::string> names = {"frame"};
  for (const std::string& name : sixteen('v')) names.push_back(name);
  for (const std::string& name : projection ? sixteen('p') : std::vector<std::string>{"focal", "aperture"})
    names.push_back(name);
  return names;
}

std::vector<double> csv_numbers(std::string_view line, std::size_t count, const std::string& where) {
  const std::vector<std::string_view> fields = split_at_commas(line);
  if (fields.size() != count)
    refuse(where, "has " + std::to_string(fields.size()) + " fields, but the header names " + std::to_string(count));
  std::vector<double> numbers;
  for (std::string_view field : fields) {
    if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (problem != std::errc() || end != field.data() + field.size() || !std::isfinite(value))
      refuse(where, "holds something that is not a finite number");
    numbers.push_back(value);
  }
  return numbers;
}

CameraRow row_of(const std::vector<double>& view, const std::vector<double>& projection, double focal,
                 double aperture) {
  CameraRow row;
  std::copy(view.begin(), view.end(), row.view.begin());
  if (projection.empty()) {
    row.focal = focal;
    row.aperture = aperture;
  } else {
    std::copy(projection.begin(), projection.end(), row.projection.emplace().begin());
  }
  return row;
}

Table read_csv(const std::string& text, const std::string& path) {
  std::istringstream in(text);
  Table table;
  std::size_t columns = 0;
  int line = 0;
  for (std::string raw; std::getline(in, raw);) {
    const std::string where = path + ":" + std::to_string(++line);
    const std::string_view rest = trimmed(raw);
    if (rest.empty() || rest.front() == '#') continue;
    if (columns == 0) {
      const std::vector<std::string_view> fields = split_at_commas(rest);
      for (const bool projection : {true, false})
        if (std::ranges::equal(fields, csv_header(projection))) columns = fields.size();
      if (columns == 0) refuse(where, std::string("this is no header of a camera file; ") + kForms);
      continue;
    }
    const std::vector<double> n = csv_numbers(rest, columns, where);
    const std::vector<double> view(n.begin() + 1, n.begin() + 17);
    const std::vector<double> projection(n.begin() + (columns == 33 ? 17 : std::ptrdiff_t(columns)), n.end());
    add(table, where, n[0], row_of(view, projection, n[17], n[18]));
  }
  return table;
}

Table read_json(const std::string& text, const std::string& path) {
  const std::optional<JsonValue> whole = parse_json(text);
  const JsonValue* list = whole && whole->kind == JsonValue::Kind::object ? whole->find("frames")
                          : whole                                         ? &*whole
                                                                          : nullptr;
  if (!list || list->kind != JsonValue::Kind::array) refuse(path, std::string("is no list of cameras; ") + kForms);
  Table table;
  int entry = 0;
  for (const JsonValue& item : list->items) {
    const std::string where = path + ", entry " + std::to_string(++entry);
    const auto number = [&](const char* name) {
      const JsonValue* member = item.find(name);
      return member && member->kind == JsonValue::Kind::number ? std::optional<double>(member->number) : std::nullopt;
    };
    const auto matrix = [&](const char* name) {
      const JsonValue* member = item.find(name);
      const std::optional<std::vector<double>> numbers = member ? member->numbers() : std::nullopt;
      if (member && (!numbers || numbers->size() != 16)) refuse(where, std::string(name) + " does not have 16 numbers");
      return numbers.value_or(std::vector<double>());
    };
    const std::optional<double> frame = number("frame"), focal = number("focal"), aperture = number("aperture");
    const std::vector<double> view = matrix("view"), projection = matrix("proj");
    if (!frame || view.empty() || (projection.empty() && !(focal && aperture)))
      refuse(where, std::string("lacks a member; ") + kForms);
    add(table, where, *frame, row_of(view, projection, focal.value_or(0), aperture.value_or(0)));
  }
  return table;
}

}  // namespace

std::map<int, CameraRow> read_camera_table(const std::string& path) {
  std::error_code problem;
  const bool looks_like_file = path.find_first_of("./") != std::string::npos || std::filesystem::exists(path, problem);
  if (!looks_like_file)
    throw Failure(ExitCode::usage, "--camera " + path + ": unknown; it takes auto, off, or a CSV or JSON file");
  const std::uintmax_t bytes = std::filesystem::file_size(path, problem);
  std::ifstream in(path, std::ios::binary);
  if (problem || !in) refuse(path, "the camera file cannot be read; --camera takes auto, off, or a CSV or JSON file");
  if (bytes > kMaxBytes) refuse(path, "is too large for a camera file (more than 64 MiB)");
  std::ostringstream buffer;
  buffer << in.rdbuf();
  if (in.bad()) refuse(path, "the camera file cannot be read to its end");
  std::string text = std::move(buffer).str();
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark of some editors
  const std::string_view start = trimmed(text);
  const bool json = !start.empty() && (start.front() == '[' || start.front() == '{');
  Table table = json ? read_json(text, path) : read_csv(text, path);
  if (table.empty()) refuse(path, std::string("holds no camera; ") + kForms);
  return table;
}

}  // namespace varve
