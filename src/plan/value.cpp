#include "plan/value.h"

#include <array>
#include <cstdio>

namespace varve {

std::string number_text(double number) {
  std::array<char, 64> buffer;
  // Whole numbers of everyday size are not turned into 1e+06.
  const bool whole = std::abs(number) < 1e15 && std::floor(number) == number;
  const auto end = whole ? std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::fixed)
                         : std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return std::string(buffer.data(), end.ptr);
}

std::string short_number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%g", value);
  return digits;
}

std::string range_text(const Range& range, bool whole) {
  return std::string(whole ? "a whole number " : "a number ") + (range.low_excluded ? "above " : "from ") +
         number_text(range.low) + (range.low_excluded ? " up to " : " to ") + number_text(range.high);
}

std::string choices_text(const std::vector<Choice>& choices) {
  std::string text = "one of ";
  for (const Choice& choice : choices) text += (text.size() > 7 ? ", " : "") + choice.word;
  return text;
}

}  // namespace varve
