#include "plan/extra_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/error.h"
#include "base/json.h"
#include "exr/sequence.h"

namespace varve {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kMaxListBytes = std::uintmax_t(256) << 20;

bool matches(std::string_view pattern, std::string_view name) {
  // Back to the last * where the rest does not fit: linear but for the product of both lengths at worst.
  std::size_t p = 0, n = 0, star = std::string_view::npos, resumed = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++, resumed = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p, ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1, n = ++resumed;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code problem;
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored)) names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_whole(double v) { return v >= -1e9 && v <= 1e9 && v == std::floor(v); }

std::optional<std::array<int, 4>> window_of(const JsonValue& render) {
  const JsonValue* member = render.find("window");
  const std::optional<std::vector<double>> n = member ? member->numbers() : std::nullopt;
  if (!n || n->size() != 4 || !std::all_of(n->begin(), n->end(), is_whole)) return std::nullopt;
  return std::array{int((*n)[0]), int((*n)[1]), int((*n)[2]), int((*n)[3])};
}

}  // namespace

std::map<int, std::vector<std::string>> find_extra_files(const std::vector<std::string>& patterns,
                                                         const std::vector<int>& frames) {
  std::map<int, std::vector<std::string>> found;
  for (const std::string& text : patterns) {
    const SequencePattern pattern = SequencePattern::parse(text);
    if (!pattern.has_frame() && frames.size() > 1)
      throw Failure(ExitCode::usage, "--extra '" + text + "' has no place for a frame number and there are " +
                                         std::to_string(frames.size()) + " frames; put it in, as in extra.*.####.exr");
    const fs::path folder = fs::path(text).parent_path();
    const std::vector<std::string> names = names_in(folder);
    for (const int frame : frames) {
      const std::string wanted = fs::path(pattern.path(frame)).filename().string();
      // Without a star the name is one of a sorted list.
      if (wanted.find('*') == std::string::npos) {
        if (std::binary_search(names.begin(), names.end(), wanted)) found[frame].push_back((folder / wanted).string());
        continue;
      }
      for (const std::string& name : names)
        if (matches(wanted, name)) found[frame].push_back((folder / name).string());
    }
  }
  for (auto& [frame, paths] : found) {
    std::sort(paths.begin(), paths.end());
    paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  }
  return found;
}

std::map<std::string, ListedExtra> read_extra_list(const std::string& path) {
  const auto refuse = [&](const std::string& why) {
    throw Failure(ExitCode::input, path + ": " + why + "; --extra-list takes a JSON file that --rerender wrote");
  };
  std::error_code problem;
  const std::uintmax_t bytes = fs::file_size(path, problem);
  std::ifstream in(path, std::ios::binary);
  if (problem || !in) refuse("cannot be read");
  if (bytes > kMaxListBytes) refuse("is larger than 256 MiB");
  std::string text(std::size_t(bytes), '\0');
  if (!in.read(text.data(), std::streamsize(text.size()))) refuse("cannot be read to its end");
  const std::optional<JsonValue> list = parse_json(text);
  const JsonValue* renders = list ? list->find("renders") : nullptr;
  if (!renders || renders->kind != JsonValue::Kind::array) refuse("is no list of renders");
  std::map<std::string, ListedExtra> files;
  for (std::size_t i = 0; i < renders->items.size(); ++i) {
    const JsonValue& render = renders->items[i];
    const std::optional<std::array<int, 4>> window = window_of(render);
    const JsonValue *names = render.find("files"), *jitter = render.find("jitter");
    if (!window || !names || names->kind != JsonValue::Kind::array)
      refuse("entry " + std::to_string(i) + " of renders has no window of four whole numbers, or no files");
    for (std::size_t k = 0; k < names->items.size(); ++k) {
      ListedExtra& extra = files[names->items[k].text];
      extra.window = *window;
      const bool told = jitter && k < jitter->items.size();
      const std::optional<std::vector<double>> at = told ? jitter->items[k].numbers() : std::nullopt;
      if (at && at->size() == 2 && std::abs((*at)[0]) <= 1 && std::abs((*at)[1]) <= 1)
        extra.jitter = Jitter{(*at)[0], (*at)[1]};
    }
  }
  return files;
}

}  // namespace varve
