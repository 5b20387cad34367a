// Text taken apart and put together: fields of a table, lines for a terminal, members of a JSON object.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json.h"

namespace varve {

/// Without the blanks around it.
std::string_view trimmed(std::string_view text);

/// The fields of a line of CSV without quotes, each trimmed; at least one.
std::vector<std::string_view> split_at_commas(std::string_view line);

/// `words` behind `line`, broken at blanks where lines get longer than 100 columns; further lines begin below the first
/// word. Ends with a line break.
std::string wrapped(std::string line, std::string_view words);

/// A JSON object. Values are JSON already; their order is kept.
std::string json_object(std::initializer_list<std::pair<const char*, std::string>> members);

/// A JSON array of what `to_json` makes of each item.
template <class Range, class ToJson>
std::string json_array(const Range& range, ToJson to_json) {
  std::string text = "[";
  for (const auto& item : range) text.append(text.size() > 1 ? "," : "").append(to_json(item));
  return text + "]";
}

inline std::string json_boolean(bool value) { return value ? "true" : "false"; }

}  // namespace varve
