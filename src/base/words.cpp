#include "base/words.h"

#include <algorithm>

namespace varve {
namespace {

constexpr std::size_t kColumns = 100;

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split_at_commas(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string wrapped(std::string line, std::string_view words) {
  std::string text;
  const std::string blank(line.size(), ' ');
  bool first = true;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (!first && line.size() + 1 + (end - at) > kColumns) {
      text += line + '\n';
      line = blank;
      first = true;
    }
    line.append(first ? "" : " ").append(words, at, end - at);
    first = false;
    at = end + 1;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return text + line + '\n';
}

std::string json_object(std::initializer_list<std::pair<const char*, std::string>> members) {
  std::string text = "{";
  for (const auto& [name, value] : members)
    text.append(text.size() > 1 ? "," : "").append(json_quote(name)).append(":").append(value);
  return text + "}";
}

}  // namespace varve
