// Where the fields of an EXR file lie, for tests that damage them one by one. A lenient walk: it goes as far as the
// bytes make sense and never fails.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace varve::test {

enum class ExrFieldKind {
  version,  ///< the four bytes behind the magic number
  attribute_name,
  attribute_type,
  attribute_size,
  attribute_value,
  header_end,   ///< the zero byte behind the attributes of a part
  table_entry,  ///< eight bytes: where a chunk lies
  chunk_part,   ///< four bytes, files of several parts only
  chunk_place,  ///< first scan line, or column, row and the two levels of a tile
  chunk_size,   ///< four bytes, or the three sizes of eight bytes of a deep chunk
  chunk_bytes,  ///< counts and pixels
};

struct ExrField {
  ExrFieldKind kind;
  std::size_t at = 0, size = 0;
  std::size_t part = 0;
  std::string attribute;  ///< name of the attribute it belongs to
};

struct ExrShape {
  std::vector<ExrField> fields;
  std::size_t table_at = 0, data_at = 0;  ///< of the chunk tables and the first chunk; 0 if the walk did not get there
  std::vector<std::size_t> chunks;        ///< where each chunk begins, in the order of the tables

  /// They point into this, which therefore has to have a name.
  std::vector<const ExrField*> of(ExrFieldKind kind) const&& = delete;
  std::vector<const ExrField*> of(ExrFieldKind kind) const& {
    std::vector<const ExrField*> found;
    for (const ExrField& field : fields)
      if (field.kind == kind) found.push_back(&field);
    return found;
  }
};

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value{};
  if (at <= bytes.size() && sizeof value <= bytes.size() - at) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// What the walk needs to know of a part.
struct ExrPartShape {
  bool tiled = false, deep = false;
};

/// Walks one header; false at its end or where it makes no sense any more.
inline bool walk_header(std::string_view bytes, std::size_t& at, std::size_t number, ExrShape& shape,
                        ExrPartShape& part) {
  const auto text_end = [&](std::size_t from) { return bytes.find('\0', from); };
  for (;;) {
    const std::size_t name_end = text_end(at);
    if (name_end == std::string_view::npos) return false;
    if (name_end == at) {
      shape.fields.push_back({ExrFieldKind::header_end, at, 1, number, {}});
      ++at;
      return true;
    }
    const std::string name(bytes.substr(at, name_end - at));
    const std::size_t type_at = name_end + 1, type_end = text_end(type_at);
    if (type_end == std::string_view::npos || type_end + 5 > bytes.size()) return false;
    const std::size_t size = number_at<std::uint32_t>(bytes, type_end + 1), value_at = type_end + 5;
    if (size > bytes.size() - value_at) return false;
    shape.fields.push_back({ExrFieldKind::attribute_name, at, name.size(), number, name});
    shape.fields.push_back({ExrFieldKind::attribute_type, type_at, type_end - type_at, number, name});
    shape.fields.push_back({ExrFieldKind::attribute_size, type_end + 1, 4, number, name});
    shape.fields.push_back({ExrFieldKind::attribute_value, value_at, size, number, name});
    const std::string_view value = bytes.substr(value_at, size);
    if (name == "type") part.deep = value.starts_with("deep"), part.tiled = value.ends_with("tile");
    if (name == "type" && value == "tiledimage") part.tiled = true;
    at = value_at + size;
  }
}

inline void walk_chunk(std::string_view bytes, std::size_t at, bool multi_part, const std::vector<ExrPartShape>& parts,
                       ExrShape& shape) {
  std::size_t number = 0;
  shape.chunks.push_back(at);
  if (multi_part) {
    if (at + 4 > bytes.size()) return;
    number = number_at<std::uint32_t>(bytes, at);
    shape.fields.push_back({ExrFieldKind::chunk_part, at, 4, number, {}});
    at += 4;
    if (number >= parts.size()) return;
  }
  const std::size_t place = parts[number].tiled ? 16 : 4, sizes = parts[number].deep ? 24 : 4;
  if (at + place + sizes > bytes.size()) return;
  for (std::size_t i = 0; i < place; i += 4) shape.fields.push_back({ExrFieldKind::chunk_place, at + i, 4, number, {}});
  at += place;
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < sizes; i += parts[number].deep ? 8 : 4) {
    shape.fields.push_back({ExrFieldKind::chunk_size, at + i, parts[number].deep ? 8u : 4u, number, {}});
    if (!parts[number].deep)
      held = number_at<std::uint32_t>(bytes, at);
    else if (i < 16)
      held += number_at<std::uint64_t>(bytes, at + i);
  }
  at += sizes;
  if (held <= bytes.size() - at) shape.fields.push_back({ExrFieldKind::chunk_bytes, at, std::size_t(held), number, {}});
}

inline ExrShape exr_shape(std::string_view bytes) {
  ExrShape shape;
  if (bytes.size() < 9) return shape;
  shape.fields.push_back({ExrFieldKind::version, 4, 4, 0, {}});
  const std::uint32_t flags = number_at<std::uint32_t>(bytes, 4);
  const bool multi_part = (flags & 0x1000) != 0;
  std::vector<ExrPartShape> parts;
  std::size_t at = 8;
  do {
    ExrPartShape part{(flags & 0x200) != 0 && !multi_part, (flags & 0x800) != 0 && !multi_part};
    if (!walk_header(bytes, at, parts.size(), shape, part)) return shape;
    parts.push_back(part);
  } while (multi_part && at < bytes.size() && bytes[at] != '\0');
  if (multi_part) {
    shape.fields.push_back({ExrFieldKind::header_end, at, 1, parts.size(), {}});
    ++at;
  }
  // The first chunk follows the tables, so that the least of the offsets tells where they end.
  shape.table_at = at;
  std::uint64_t end = bytes.size();
  std::vector<std::uint64_t> offsets;
  for (; at + 8 <= end; at += 8) {
    const std::uint64_t offset = number_at<std::uint64_t>(bytes, at);
    if (offset > at && offset < end) end = offset;
    offsets.push_back(offset);
    shape.fields.push_back({ExrFieldKind::table_entry, at, 8, 0, {}});
  }
  shape.data_at = at;
  for (std::uint64_t offset : offsets)
    if (offset >= shape.data_at && offset < bytes.size())
      walk_chunk(bytes, std::size_t(offset), multi_part, parts, shape);
  return shape;
}

}  // namespace varve::test
