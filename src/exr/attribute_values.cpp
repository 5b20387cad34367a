// Attribute bytes as text and numbers.
#include <charconv>
#include <cmath>

#include "exr/header_bytes.h"

namespace varve {
namespace {

struct NumericType {
  const char* name;
  char element;  // i int32, u uint32, f float, d double; r: int32 over uint32
  int count;     // 0: as many as the bytes hold
};
constexpr NumericType kNumeric[] = {
    {"int", 'i', 1},
    {"float", 'f', 1},
    {"double", 'd', 1},
    {"v2i", 'i', 2},
    {"v2f", 'f', 2},
    {"v2d", 'd', 2},
    {"v3i", 'i', 3},
    {"v3f", 'f', 3},
    {"v3d", 'd', 3},
    {"box2i", 'i', 4},
    {"box2f", 'f', 4},
    {"m33f", 'f', 9},
    {"m33d", 'd', 9},
    {"m44f", 'f', 16},
    {"m44d", 'd', 16},
    {"rational", 'r', 2},
    {"chromaticities", 'f', 8},
    {"floatvector", 'f', 0},
    {"keycode", 'i', 7},
    {"timecode", 'u', 2},
};

double element(char kind, const char* at) {
  switch (kind) {
    case 'i':
      return load<std::int32_t>(at);
    case 'u':
      return load<std::uint32_t>(at);
    case 'f':
      return double(load<float>(at));
    default:
      return load<double>(at);
  }
}

std::string shortest(char kind, double value) {
  char digits[40];
  // A float is printed as a float, or 0.1 would read 0.10000000149011612.
  const auto end = kind == 'f' ? std::to_chars(digits, digits + sizeof digits, float(value)).ptr
                               : std::to_chars(digits, digits + sizeof digits, value).ptr;
  return std::string(digits, end);
}

void decode_numbers(const RawAttribute& raw, const NumericType& type, Attribute& into) {
  const std::size_t size = type.element == 'd' ? 8 : 4;
  const std::size_t count = type.count > 0 ? std::size_t(type.count) : raw.value.size() / size;
  if (raw.value.size() != count * size) return;
  for (std::size_t i = 0; i < count; ++i) {
    const char kind = type.element != 'r' ? type.element : i == 0 ? 'i' : 'u';
    const double value = element(kind, raw.value.data() + i * size);
    into.numbers.push_back(value);
    if (i > 0) into.text += ' ';
    into.text += shortest(kind, value);
  }
}

}  // namespace

std::vector<std::string> decode_strings(const std::string& value) {
  std::vector<std::string> strings;
  std::size_t at = 0;
  while (value.size() - at >= 4) {
    const std::uint32_t length = load<std::uint32_t>(value.data() + at);
    at += 4;
    if (length > value.size() - at) return {};
    strings.emplace_back(value, at, length);
    at += length;
  }
  return strings;
}

Attribute decode_attribute(const RawAttribute& raw) {
  Attribute attribute{raw.name, raw.type, {}, {}};
  if (raw.type == "string") {
    attribute.text = raw.value;
  } else if (raw.type == "stringvector") {
    for (const std::string& s : decode_strings(raw.value)) {
      if (!attribute.text.empty()) attribute.text += ", ";
      attribute.text += s;
    }
  } else {
    for (const NumericType& type : kNumeric)
      if (raw.type == type.name) decode_numbers(raw, type, attribute);
  }
  return attribute;
}

}  // namespace varve
