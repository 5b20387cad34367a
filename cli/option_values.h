// Makers of option values: flags, texts, patterns and lists, and those that need more than one field.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "option.h"

namespace varve::cli {

template <class At, class T, std::size_t N>
Value<Settings> word(At at, const Word<T> (&words)[N]) {
  return word_value<Settings>(at, std::span<const Word<T>>(words));
}

template <class At>
Value<Settings> number(At at, Range range) {
  return number_value<Settings>(at, range);
}

template <class At>
Value<Settings> flag(At at) {
  return {[at](Settings& s, std::string_view) { return at(s) = true; }, nullptr, "", {}};
}

template <class At>
Value<Settings> text(At at, std::string allowed) {
  return {[at](Settings& s, std::string_view text) {
            at(s) = text;
            return !text.empty();
          },
          [at](const Settings& s) { return std::string(at(s)); },
          std::move(allowed),
          {}};
}

template <class At>
Value<Settings> pattern(At at) {
  return {[at](Settings& s, std::string_view text) {
            at(s) = SequencePattern::parse(text);
            return true;
          },
          nullptr,
          "a file name such as shot.####.exr, shot.%04d.exr or shot.$F4.exr",
          {}};
}

template <class At>
Value<Settings> frames(At at) {
  return {[at](Settings& s, std::string_view text) {
            std::vector<int> list = parse_frame_list(text);
            if (list.empty()) return false;
            at(s) = std::move(list);
            return true;
          },
          nullptr,
          "a list of frames such as 1-10,20,30-50x2",
          {}};
}

/// Items between commas; empty items are refused. Calls add(settings, item), which returns false to refuse one.
template <class Add>
Value<Settings> list(Add add, std::string allowed) {
  return {[add](Settings& s, std::string_view text) {
            for (bool more = true; more;) {
              const std::size_t comma = std::min(text.find(','), text.size());
              more = comma < text.size();
              if (comma == 0 || !add(s, std::string(text.substr(0, comma)))) return false;
              text.remove_prefix(std::min(comma + 1, text.size()));
            }
            return true;
          },
          nullptr,
          std::move(allowed),
          {}};
}

/// A value that overrides the motion convention only when it is given, which `is_set(settings)` records.
template <class IsSet>
Value<Settings> overriding(const Value<Settings>& value, IsSet is_set) {
  return {
      [is_set, read = value.read](Settings& s, std::string_view text) { return read(s, text) && (is_set(s) = true); },
      nullptr, value.allowed, value.choices};
}

/// role=channel.
Value<Settings> map_value();
/// Names of diagnostic planes.
Value<Settings> aovs_value();
/// auto, or a row of the convention table.
Value<Settings> convention_value();
/// What is done with samples, and which they are.
Value<Settings> samples_value();

/// A jitter pattern for frames that do not tell theirs.
Value<Settings> assumed_jitter();
/// Sets all parameters.
Value<Settings> preset_value();
/// 320x180.
Value<Settings> size_value(std::function<void(Settings&, int width, int height)> set);
/// Numbers of --yardsticks.
Value<Settings> yardsticks_value();
/// A parameter of the resolve.
Value<Settings> knob_value(const Knob& knob);

}  // namespace varve::cli
