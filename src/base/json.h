// JSON: a small strict reader for the notes renderers leave in headers, and the escaping every writer needs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace varve {

struct JsonMember;

/// One value of a JSON text. Only the member that `kind` names means anything.
struct JsonValue {
  enum class Kind { null, boolean, number, string, array, object } kind = Kind::null;
  bool boolean = false;
  double number = 0;  ///< always finite
  std::string text;
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;  ///< in file order; names may repeat

  /// First member of that name; null if this is no object or has none.
  const JsonValue* find(std::string_view name) const;
  /// The numbers of an array that holds nothing else; none otherwise.
  std::optional<std::vector<double>> numbers() const;
};

struct JsonMember {
  std::string name;
  JsonValue value;
};

/// Reads one whole JSON text (RFC 8259, surrounding blanks allowed). None for anything else: trailing characters,
/// numbers beyond double, arrays and objects nested deeper than `max_depth`.
std::optional<JsonValue> parse_json(std::string_view text, int max_depth = 32);

/// `text` as a JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD, so the result is always valid.
std::string json_quote(std::string_view text);

/// A number as JSON: the shortest text that reads back as the same double; null if it is not finite.
std::string json_number(double value);

}  // namespace varve
