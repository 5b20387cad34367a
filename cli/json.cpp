#include "json.h"

#include <cmath>

#include "plan/value.h"

namespace varve::cli {
namespace {

std::string quoted(std::string_view text) {
  constexpr char hex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (byte < 0x20)
      out += std::string("\\u00") + hex[byte >> 4] + hex[byte & 15];
    else
      out += c;
  }
  return out + "\"";
}

}  // namespace

void JsonLine::key(std::string_view name) { line_ += (line_.size() > 1 ? "," : "") + quoted(name) + ":"; }

JsonLine& JsonLine::text(std::string_view name, std::string_view value) {
  key(name);
  line_ += quoted(value);
  return *this;
}

JsonLine& JsonLine::number(std::string_view name, double value) {
  key(name);
  line_ += std::isfinite(value) ? number_text(value) : "null";
  return *this;
}

JsonLine& JsonLine::flag(std::string_view name, bool value) {
  key(name);
  line_ += value ? "true" : "false";
  return *this;
}

}  // namespace varve::cli
