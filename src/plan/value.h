// A value that text can set: a field of a settings struct with its range or its words. The parameter dump, the presets,
// the command line, --help and the manual all read these, so that no range, word or default is typed twice.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace varve {

/// Both ends are allowed, except `low` when it is excluded. Ends are finite: inf and nan are never accepted.
struct Range {
  double low = 0, high = 1;
  bool low_excluded = false;
};

/// A word that stands for a value, and what it means in one line.
template <class T>
struct Word {
  std::string_view word;
  T value;
  std::string_view meaning;
};

struct Choice {
  std::string word, meaning;
};

template <class S>
struct Value {
  std::function<bool(S&, std::string_view text)> read;  ///< false: not accepted, nothing changed
  std::function<std::string(const S&)> show;            ///< "" when the field holds nothing
  std::string allowed;                                  ///< completes "takes ...": "a number from 0 to 1"
  std::vector<Choice> choices;                          ///< words, where there are any
};

/// The whole text as a finite number: no blanks, no trailing junk, no inf or nan, nothing beyond the range of T.
template <class T>
std::optional<T> parse_number(std::string_view text) {
  T number{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(number)) return std::nullopt;
  return number;
}

/// Shortest text that reads back as the same number; plain digits where that is short.
std::string number_text(double number);
/// Six digits at most, for sentences.
std::string short_number(double value);

/// "a number above 0 up to 1", "a whole number from 3 to 7".
std::string range_text(const Range& range, bool whole);

/// "one of none, nearest, longest".
std::string choices_text(const std::vector<Choice>& choices);

/// A number in a range. `at(settings)` is the field, double or int.
template <class S, class At>
Value<S> number_value(At at, Range range) {
  using T = std::remove_cvref_t<decltype(at(std::declval<S&>()))>;
  Value<S> value;
  value.allowed = range_text(range, std::is_integral_v<T>);
  value.read = [at, range](S& settings, std::string_view text) {
    const std::optional<T> number = parse_number<T>(text);
    if (!number) return false;
    const double d = double(*number);
    if (!((range.low_excluded ? d > range.low : d >= range.low) && d <= range.high)) return false;
    at(settings) = *number;
    return true;
  };
  value.show = [at](const S& settings) { return number_text(double(at(settings))); };
  return value;
}

/// One of a table of words. `at(settings)` is the field: an enum, or any comparable value.
template <class S, class At, class T>
Value<S> word_value(At at, std::span<const Word<T>> words) {
  Value<S> value;
  for (const Word<T>& word : words) value.choices.push_back({std::string(word.word), std::string(word.meaning)});
  value.allowed = choices_text(value.choices);
  value.read = [at, words](S& settings, std::string_view text) {
    for (const Word<T>& word : words)
      if (word.word == text) {
        at(settings) = word.value;
        return true;
      }
    return false;
  };
  value.show = [at, words](const S& settings) {
    for (const Word<T>& word : words)
      if (word.value == at(settings)) return std::string(word.word);
    return std::string();
  };
  return value;
}

/// The same value as a field of something larger: `at(settings)` is the struct that the value belongs to.
template <class S, class P, class At>
Value<S> inside(const Value<P>& value, At at) {
  return {[read = value.read, at](S& settings, std::string_view text) { return read(at(settings), text); },
          [show = value.show, at](const S& settings) { return show(at(settings)); }, value.allowed, value.choices};
}

}  // namespace varve
