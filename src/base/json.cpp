#include "base/json.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

namespace varve {
namespace {

// A value takes fifty times the bytes of the shortest text for one: 4 M of them are some 450 MiB, and the cameras of a
// hundred thousand frames.
constexpr std::size_t kMostValues = std::size_t(1) << 22;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

void append_utf8(std::string& out, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { out += char(static_cast<unsigned char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | code >> 6), put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12), put(0x80 | (code >> 6 & 0x3F)), put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | code >> 18), put(0x80 | (code >> 12 & 0x3F)), put(0x80 | (code >> 6 & 0x3F)), put(0x80 | (code & 0x3F));
  }
}

/// Recursive descent over what is left of the text; every method returns false on anything that is not JSON.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool document(JsonValue& value, int depth) { return this->value(value, depth) && (blanks(), rest_.empty()); }

 private:
  void blanks() {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\n' || rest_[0] == '\r'))
      rest_.remove_prefix(1);
  }
  bool take(char c) {
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool word(std::string_view expected) {
    if (!rest_.starts_with(expected)) return false;
    rest_.remove_prefix(expected.size());
    return true;
  }

  bool value(JsonValue& out, int depth) {
    blanks();
    if (rest_.empty() || ++values_ > kMostValues) return false;
    switch (rest_[0]) {
      case '{':
        return depth > 0 && object(out, depth - 1);
      case '[':
        return depth > 0 && array(out, depth - 1);
      case '"':
        out.kind = JsonValue::Kind::string;
        return string(out.text);
      case 'n':
        return word("null");
      case 't':
        out.kind = JsonValue::Kind::boolean;
        out.boolean = true;
        return word("true");
      case 'f':
        out.kind = JsonValue::Kind::boolean;
        return word("false");
      default:
        out.kind = JsonValue::Kind::number;
        return number(out.number);
    }
  }

  bool array(JsonValue& out, int depth) {
    out.kind = JsonValue::Kind::array;
    take('[');
    blanks();
    if (take(']')) return true;
    do {
      if (!value(out.items.emplace_back(), depth)) return false;
      blanks();
    } while (take(','));
    return take(']');
  }

  bool object(JsonValue& out, int depth) {
    out.kind = JsonValue::Kind::object;
    take('{');
    blanks();
    if (take('}')) return true;
    do {
      blanks();
      auto& [name, member] = out.members.emplace_back();
      if (!string(name)) return false;
      blanks();
      if (!take(':') || !value(member, depth)) return false;
      blanks();
    } while (take(','));
    return take('}');
  }

  bool number(double& out) {
    std::size_t end = 0;
    const auto digits = [&] {
      const std::size_t begin = end;
      while (end < rest_.size() && is_digit(rest_[end])) ++end;
      return end > begin;
    };
    const auto at = [&](char c) { return end < rest_.size() && rest_[end] == c; };
    if (at('-')) ++end;
    const bool zero = at('0');
    const std::size_t first = end;
    if (!digits() || (zero && end > first + 1)) return false;
    if (at('.') && (++end, !digits())) return false;
    if (at('e') || at('E')) {
      ++end;
      if (at('+') || at('-')) ++end;
      if (!digits()) return false;
    }
    const auto [stop, problem] = std::from_chars(rest_.data(), rest_.data() + end, out);
    if (problem != std::errc() || stop != rest_.data() + end || !std::isfinite(out)) return false;
    rest_.remove_prefix(end);
    return true;
  }

  bool hex4(std::uint32_t& code) {
    if (rest_.size() < 4) return false;
    const auto [stop, problem] = std::from_chars(rest_.data(), rest_.data() + 4, code, 16);
    if (problem != std::errc() || stop != rest_.data() + 4) return false;
    rest_.remove_prefix(4);
    return true;
  }

  bool escape(std::string& out) {
    if (rest_.empty()) return false;
    const char c = rest_[0];
    rest_.remove_prefix(1);
    switch (c) {
      case '"':
      case '\\':
      case '/':
        out += c;
        return true;
      case 'b':
        out += '\b';
        return true;
      case 'f':
        out += '\f';
        return true;
      case 'n':
        out += '\n';
        return true;
      case 'r':
        out += '\r';
        return true;
      case 't':
        out += '\t';
        return true;
      case 'u':
        break;
      default:
        return false;
    }
    std::uint32_t code = 0, low = 0;
    if (!hex4(code)) return false;
    if (code >= 0xD800 && code < 0xDC00) {  // the first half of a surrogate pair must be followed by the second
      if (!word("\\u") || !hex4(low) || low < 0xDC00 || low > 0xDFFF) return false;
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    } else if (code >= 0xDC00 && code < 0xE000) {
      return false;
    }
    append_utf8(out, code);
    return true;
  }

  bool string(std::string& out) {
    if (!take('"')) return false;
    while (!rest_.empty()) {
      const char c = rest_[0];
      rest_.remove_prefix(1);
      if (c == '"') return true;
      if (static_cast<unsigned char>(c) < 0x20) return false;
      if (c != '\\')
        out += c;
      else if (!escape(out))
        return false;
    }
    return false;
  }

  std::string_view rest_;
  std::size_t values_ = 0;
};

// Length of the well-formed UTF-8 sequence at the start of `text`; 0 if there is none (RFC 3629).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) -> unsigned { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  // Overlong forms, surrogates and codes beyond U+10FFFF show in the second byte.
  const unsigned low = lead == 0xE0   ? 0xA0
                       : lead == 0xF0 ? 0x90
                                      : 0x80,
                 high = lead == 0xED   ? 0x9F
                        : lead == 0xF4 ? 0x8F
                                       : 0xBF;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i)
    if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
  return length;
}

}  // namespace

const JsonValue* JsonValue::find(std::string_view name) const {
  if (kind != Kind::object) return nullptr;
  for (const auto& [key, value] : members)
    if (key == name) return &value;
  return nullptr;
}

std::optional<std::vector<double>> JsonValue::numbers() const {
  if (kind != Kind::array) return std::nullopt;
  std::vector<double> values;
  for (const JsonValue& item : items) {
    if (item.kind != Kind::number) return std::nullopt;
    values.push_back(item.number);
  }
  return values;
}

std::optional<JsonValue> parse_json(std::string_view text, int max_depth) {
  JsonValue value;
  if (!Reader(text).document(value, max_depth)) return std::nullopt;
  return value;
}

std::string json_quote(std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const unsigned char c = static_cast<unsigned char>(text[0]);
    if (length == 0)
      out += "\\ufffd";
    else if (c == '"' || c == '\\')
      out += '\\', out += char(c);
    else if (c < 0x20)
      out += "\\u00", out += kHex[c >> 4], out += kHex[c & 15];
    else
      out += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out + '"';
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  char digits[32];
  const auto [end, problem] = std::to_chars(digits, digits + sizeof digits, value);
  return problem == std::errc() ? std::string(digits, end) : "null";
}

}  // namespace varve
