#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "fuzz/targets.h"
#include "support/exr_shape.h"

namespace varve::fuzz {
namespace {

using test::ExrField;
using test::ExrFieldKind;
using test::ExrShape;

std::size_t below(Random& random, std::size_t n) { return n == 0 ? 0 : std::size_t(random() % n); }
bool chance(Random& random, int one_in) { return random() % std::uint64_t(one_in) == 0; }

template <class Values>
auto any_of(Random& random, const Values& values) {
  return values[below(random, std::size(values))];
}

/// Numbers that lie at an edge of something.
std::uint64_t telling_number(Random& random, std::uint64_t now, std::size_t file_bytes) {
  constexpr std::array<std::uint64_t, 22> kEdges = {
      0,   1,   2,   3,     7,     8,          15,         16,      17,         31,         127,
      128, 255, 256, 65535, 65536, 0x7FFFFFFF, 0x80000000, 1 << 20, 0xFFFFFFFF, 0xFFFFFFFE, 1ull << 63};
  switch (below(random, 8)) {
    case 0:
      return now + 1;
    case 1:
      return now - 1;
    case 2:
      return now * 2;
    case 3:
      return now ^ (std::uint64_t(1) << below(random, 32));
    case 4:
      return file_bytes - below(random, 3);
    case 5:
      return random() >> below(random, 64);
    case 6:
      return ~now + 1;
    default:
      return any_of(random, kEdges);
  }
}

void put(std::string& bytes, std::size_t at, std::size_t size, std::uint64_t value) {
  for (std::size_t i = 0; i < size && i < 8 && at + i < bytes.size(); ++i) bytes[at + i] = char(value >> (8 * i));
}

std::uint64_t get(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size && i < 8 && at + i < bytes.size(); ++i)
    value |= std::uint64_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

/// Replaces bytes by others; with `repair`, offsets to what lies behind them move along.
void splice(std::string& bytes, const ExrShape& shape, std::size_t at, std::size_t size, const std::string& with,
            bool repair) {
  const auto moved = [&](std::size_t place) { return place >= at + size ? place - size + with.size() : place; };
  std::vector<std::pair<std::size_t, std::uint64_t>> entries;
  for (const ExrField* entry : shape.of(ExrFieldKind::table_entry))
    entries.emplace_back(moved(entry->at), moved(std::size_t(get(bytes, entry->at, 8))));
  bytes.replace(at, size, with);
  for (const auto& [place, offset] : entries)
    if (repair) put(bytes, place, 8, offset);
}

const ExrField* any_field(Random& random, const ExrShape& shape, ExrFieldKind kind) {
  const std::vector<const ExrField*> fields = shape.of(kind);
  return fields.empty() ? nullptr : any_of(random, fields);
}

const ExrField* value_of(Random& random, const ExrShape& shape, std::string_view attribute) {
  std::vector<const ExrField*> found;
  for (const ExrField* field : shape.of(ExrFieldKind::attribute_value))
    if (field->attribute == attribute) found.push_back(field);
  return found.empty() ? nullptr : any_of(random, found);
}

void change_window(std::string& bytes, const ExrShape& shape, Random& random) {
  const ExrField* window = value_of(random, shape, chance(random, 3) ? "displayWindow" : "dataWindow");
  if (!window) return;
  const std::size_t at = window->at + 4 * below(random, 4);
  put(bytes, at, 4, telling_number(random, get(bytes, at, 4), bytes.size()));
}

void change_tiles(std::string& bytes, const ExrShape& shape, Random& random) {
  const ExrField* tiles = value_of(random, shape, "tiles");
  if (!tiles) return;
  if (chance(random, 3))
    put(bytes, tiles->at + 8, 1, random());
  else
    put(bytes, tiles->at + 4 * below(random, 2), 4, telling_number(random, 8, bytes.size()));
}

/// Name, type, sampling of a channel, or the channel twice or not at all.
void change_channels(std::string& bytes, const ExrShape& shape, Random& random) {
  const ExrField* list = value_of(random, shape, "channels");
  if (!list) return;
  const std::string value = bytes.substr(list->at, list->size);
  std::vector<std::pair<std::size_t, std::size_t>> entries;
  for (std::size_t at = 0; at < value.size() && value[at] != '\0';) {
    const std::size_t end = value.find('\0', at);
    if (end == std::string::npos || end + 17 > value.size()) break;
    entries.emplace_back(at, end);
    at = end + 17;
  }
  if (entries.empty()) return;
  const auto [at, end] = any_of(random, entries);
  std::string changed = value;
  switch (below(random, 6)) {
    case 0:
      put(changed, end + 1, 4, below(random, 5));
      break;
    case 1:
      put(changed, end + 9 + 4 * below(random, 2), 4, telling_number(random, 1, bytes.size()));
      break;
    case 2:
      changed.insert(at, value.substr(at, end + 17 - at));
      break;
    case 3:
      changed.erase(at, end + 17 - at);
      break;
    case 4: {
      constexpr std::array<const char*, 12> kNames = {"R", "Z",          "A",      "velocity.x", "s0.R",  "a..b",
                                                      ".", "sample.0.R", "left.R", "\xff\xfe",   "ZBack", "id"};
      changed.replace(at, end - at, any_of(random, kNames));
      break;
    }
    default:
      changed.replace(at, end - at, std::string(below(random, 300), 'x'));
  }
  splice(bytes, shape, list->at, list->size, changed, true);
  put(bytes, list->at - 4, 4, chance(random, 8) ? random() : changed.size());
}

/// Attributes gone, twice, renamed, retyped, longer and shorter.
void change_attribute(std::string& bytes, const ExrShape& shape, Random& random) {
  const ExrField* value = any_field(random, shape, ExrFieldKind::attribute_value);
  const ExrField* name = nullptr;
  const ExrField* type = nullptr;
  for (const ExrField& field : shape.fields) {
    if (!value || field.part != value->part || field.attribute != value->attribute) continue;
    if (field.kind == ExrFieldKind::attribute_name) name = &field;
    if (field.kind == ExrFieldKind::attribute_type) type = &field;
  }
  if (!value || !name || !type || name->at > value->at) return;
  const std::size_t end = value->at + value->size;
  const bool repair = !chance(random, 4);
  constexpr std::array<const char*, 12> kTypes = {"int",    "float", "string", "box2i",   "v2f",      "m44f",
                                                  "chlist", "",      "m33d",   "keycode", "rational", "stringvector"};
  switch (below(random, 7)) {
    case 0:
      return splice(bytes, shape, name->at, end - name->at, "", repair);
    case 1:
      return splice(bytes, shape, name->at, 0, bytes.substr(name->at, end - name->at), repair);
    case 2:
      return splice(bytes, shape, type->at, type->size, any_of(random, kTypes), repair);
    case 3: {
      const ExrField* other = any_field(random, shape, ExrFieldKind::attribute_name);
      return splice(bytes, shape, name->at, name->size, bytes.substr(other->at, other->size), repair);
    }
    case 4: {
      const std::size_t length = below(random, 2 * value->size + 3);
      const std::string grown = (bytes.substr(value->at, value->size) + std::string(length, 'q')).substr(0, length);
      splice(bytes, shape, value->at, value->size, grown, repair);
      return put(bytes, value->at - 4, 4, length);
    }
    case 5:  // the value of another attribute of the same name: names of parts and views that come twice
      for (const ExrField* other : shape.of(ExrFieldKind::attribute_value))
        if (other->attribute == value->attribute && other->at != value->at) {
          const std::string copied = bytes.substr(other->at, other->size);
          splice(bytes, shape, value->at, value->size, copied, repair);
          return put(bytes, value->at - 4, 4, copied.size());
        }
      return;
    default:
      return put(bytes, value->at + below(random, value->size), 1, random());
  }
}

void change_table(std::string& bytes, const ExrShape& shape, Random& random) {
  const ExrField* entry = any_field(random, shape, ExrFieldKind::table_entry);
  const ExrField* other = any_field(random, shape, ExrFieldKind::table_entry);
  if (!entry) return;
  const std::uint64_t now = get(bytes, entry->at, 8), there = get(bytes, other->at, 8);
  switch (below(random, 5)) {
    case 0:
      return put(bytes, entry->at, 8, there);
    case 1:
      put(bytes, other->at, 8, now);
      return put(bytes, entry->at, 8, there);
    case 2:
      return put(bytes, entry->at, 8, shape.table_at + below(random, 64));
    case 3:
      return put(bytes, entry->at, 8, now + below(random, 33) - 16);
    default:
      return put(bytes, entry->at, 8, telling_number(random, now, bytes.size()));
  }
}

void change_number(std::string& bytes, const ExrShape& shape, Random& random, ExrFieldKind kind) {
  if (const ExrField* field = any_field(random, shape, kind))
    put(bytes, field->at, field->size, telling_number(random, get(bytes, field->at, field->size), bytes.size()));
}

/// Damage inside the packed bytes, mostly at their start where codecs keep their own sizes; or fewer or more of them.
void change_pixels(std::string& bytes, const ExrShape& shape, Random& random) {
  const ExrField* pixels = any_field(random, shape, ExrFieldKind::chunk_bytes);
  if (!pixels || pixels->size == 0) return;
  const std::size_t reach = chance(random, 2) ? std::min<std::size_t>(pixels->size, 96) : pixels->size;
  const std::size_t at = pixels->at + below(random, reach);
  const std::size_t left = pixels->at + pixels->size - at;
  switch (below(random, 6)) {
    case 0:
      return put(bytes, at, 1, random());
    case 1:
      bytes[at] = char(bytes[at] ^ (1 << below(random, 8)));
      return;
    case 2:
      return put(bytes, at, std::min<std::size_t>(left, 4), telling_number(random, get(bytes, at, 4), bytes.size()));
    case 3:
      return put(bytes, at, std::min<std::size_t>(left, 8), telling_number(random, get(bytes, at, 8), bytes.size()));
    case 4:
      for (std::size_t i = 0; i < std::min<std::size_t>(left, 16); ++i) bytes[at + i] = char(random());
      return;
    default: {
      const std::size_t cut = std::min(left, 1 + below(random, 24));
      const bool longer = chance(random, 2);
      const std::size_t was = pixels->size, size_at = pixels->at - 4;
      splice(bytes, shape, at, longer ? 0 : cut, longer ? std::string(cut, char(random())) : "", true);
      if (!chance(random, 4)) put(bytes, size_at, 4, longer ? was + cut : was - cut);
    }
  }
}

void cut_off(std::string& bytes, const ExrShape& shape, Random& random) {
  std::vector<std::size_t> places = shape.chunks;
  for (const ExrField& field : shape.fields) places.push_back(field.at), places.push_back(field.at + field.size);
  const std::size_t at = places.empty() ? bytes.size() : any_of(random, places);
  bytes.resize(std::min(bytes.size(), at + below(random, 3) - std::min<std::size_t>(at, 1)));
}

/// Few files have the right flags by chance.
void change_flags(std::string& bytes, Random& random) {
  constexpr std::array<std::uint32_t, 4> kFlags = {0x200, 0x400, 0x800, 0x1000};
  put(bytes, 4, 4, chance(random, 4) ? random() : get(bytes, 4, 4) ^ any_of(random, kFlags));
}

void damage_once(std::string& bytes, Random& random) {
  const ExrShape shape = test::exr_shape(bytes);
  switch (below(random, 24)) {
    case 0:
    case 1:
      return change_window(bytes, shape, random);
    case 2:
      return change_tiles(bytes, shape, random);
    case 3:
    case 4:
      return change_channels(bytes, shape, random);
    case 5:
    case 6:
    case 7:
      return change_attribute(bytes, shape, random);
    case 8:
    case 9:
      return change_table(bytes, shape, random);
    case 10:
      return change_number(bytes, shape, random, ExrFieldKind::attribute_size);
    case 11:
      return change_number(bytes, shape, random, ExrFieldKind::chunk_place);
    case 12:
    case 13:
    case 14:
      return change_number(bytes, shape, random, ExrFieldKind::chunk_size);
    case 15:
      return change_number(bytes, shape, random, ExrFieldKind::chunk_part);
    case 16:
      return cut_off(bytes, shape, random);
    case 17:
      if (const ExrField* compression = value_of(random, shape, "compression"))
        put(bytes, compression->at, 1, below(random, 12));
      return;
    case 18:
      if (chance(random, 4)) change_flags(bytes, random);
      [[fallthrough]];
    default:
      return change_pixels(bytes, shape, random);
  }
}

}  // namespace

std::string mutate_exr(const std::string& bytes, Random& random) {
  std::string damaged = bytes;
  for (std::size_t times = 1 + below(random, 3); times > 0; --times) damage_once(damaged, random);
  return damaged;
}

}  // namespace varve::fuzz
