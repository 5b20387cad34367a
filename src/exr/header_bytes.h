// Values inside header bytes: little-endian numbers, names, and the part they describe.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exr/container.h"

namespace varve {

static_assert(std::endian::native == std::endian::little, "OpenEXR is little-endian; other machines need byte swaps");

template <class T>
T load(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
void append(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof bytes);
}

/// The value as text and numbers, where the type has them. Boxes stay inclusive, as stored.
Attribute decode_attribute(const RawAttribute& raw);
/// Strings of a `stringvector`; empty if the bytes do not hold one.
std::vector<std::string> decode_strings(const std::string& value);

/// The value of a `chlist`, names ascending as OpenEXR demands.
std::string encode_channels(std::vector<Channel> channels);

/// Turns the attributes of one part into what they mean; `flags` are those of the file's version field.
/// Throws a plain reason as std::runtime_error: the caller knows the path.
Part decode_part(RawPart& raw, std::uint32_t flags, const ReadLimits& limits);

inline constexpr std::uint32_t kTiledFlag = 0x200, kLongNamesFlag = 0x400, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;

}  // namespace varve
