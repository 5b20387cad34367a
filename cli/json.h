// A JSON object on one line.
#pragma once

#include <string>
#include <string_view>

namespace varve::cli {

/// Fields in the order of the calls: JsonLine().text("event", "frame").number("frame", 7).end().
class JsonLine {
 public:
  JsonLine& text(std::string_view name, std::string_view value);
  JsonLine& number(std::string_view name, double value);  ///< null when it is not finite
  JsonLine& flag(std::string_view name, bool value);
  JsonLine& json(std::string_view name, const std::string& value) { return add(name, value); }  ///< as it is
  std::string end() const { return line_ + "}"; }

 private:
  JsonLine& add(std::string_view name, const std::string& value);
  std::string line_ = "{";
};

}  // namespace varve::cli
