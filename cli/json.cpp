#include "json.h"

#include "base/json.h"

namespace varve::cli {

JsonLine& JsonLine::add(std::string_view name, const std::string& value) {
  if (line_.size() > 1) line_ += ',';
  line_.append(json_quote(name)).append(":").append(value);
  return *this;
}

JsonLine& JsonLine::text(std::string_view name, std::string_view value) { return add(name, json_quote(value)); }
JsonLine& JsonLine::number(std::string_view name, double value) { return add(name, json_number(value)); }
JsonLine& JsonLine::flag(std::string_view name, bool value) { return add(name, value ? "true" : "false"); }

}  // namespace varve::cli
