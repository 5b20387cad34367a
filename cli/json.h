// A JSON object on one line.
#pragma once

#include <string>
#include <string_view>

namespace varve::cli {

/// Fields in the order of the calls: JsonLine().text("event", "frame").number("frame", 7).end().
class JsonLine {
 public:
  JsonLine& text(std::string_view key, std::string_view value);
  JsonLine& number(std::string_view key, double value);  ///< null when it is not finite
  JsonLine& flag(std::string_view key, bool value);
  std::string end() const { return line_ + "}"; }

 private:
  void key(std::string_view name);
  std::string line_ = "{";
};

}  // namespace varve::cli
