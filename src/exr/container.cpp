#include "exr/container.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "exr/header_bytes.h"

namespace varve {
namespace {

constexpr std::uint32_t kMagic = 20000630;
// Headers beyond this are no headers: the largest seen (Cryptomatte manifests of a whole scene) have some ten MiB.
constexpr std::uint64_t kHeaderBytes = std::uint64_t(1) << 28;
constexpr std::size_t kAttributes = 1 << 14;

// Walks the header bytes; what is not there is never allocated.
class HeaderCursor {
 public:
  explicit HeaderCursor(const InputBytes& file) : file_(file) {}

  std::uint64_t offset() const { return offset_; }
  [[noreturn]] void damaged() const {
    throw Failure(ExitCode::input, "'" + file_.path() + "' has a damaged header; render or copy it again");
  }
  char byte() {
    need(1);
    return block_[offset_++ - start_];
  }
  std::uint32_t number() {
    std::string four = bytes(4);
    return load<std::uint32_t>(four.data());
  }
  // A name of at most 255 characters, without its terminator.
  std::string name() {
    std::string text;
    for (char c = byte(); c != '\0'; c = byte()) {
      if (text.size() == 255) damaged();
      text += c;
    }
    return text;
  }
  std::string bytes(std::uint64_t count) {
    if (offset_ > file_.size() || count > file_.size() - offset_ || count > kHeaderBytes - offset_)
      throw Failure(ExitCode::input,
                    "'" + file_.path() + "' is cut off or damaged in its header; render or copy it again");
    std::string value(std::size_t(count), '\0');
    file_.read(offset_, value.data(), value.size(), "header");
    offset_ += count;
    return value;
  }

 private:
  void need(std::size_t count) {
    if (offset_ >= start_ && offset_ + count <= start_ + block_.size()) return;
    start_ = offset_;
    block_.resize(1 << 14);
    block_.resize(file_.read_some(start_, block_.data(), block_.size()));
    if (block_.size() < count || offset_ > kHeaderBytes)
      throw Failure(ExitCode::input, "'" + file_.path() + "' is cut off in its header; render or copy it again");
  }

  const InputBytes& file_;
  std::uint64_t offset_ = 0, start_ = 0;
  std::string block_;
};

// Attributes up to the empty name that ends a header; false when the header is empty.
bool read_attributes(HeaderCursor& cursor, RawPart& part) {
  std::unordered_map<std::string, std::size_t> places;  // a search for each name would take minutes over large headers
  for (std::string name = cursor.name(); !name.empty(); name = cursor.name()) {
    const std::string type = cursor.name();
    const std::uint32_t size = cursor.number();
    RawAttribute attribute{name, type, cursor.bytes(size)};
    const auto [place, fresh] = places.try_emplace(name, part.attributes.size());
    if (fresh)
      part.attributes.push_back(std::move(attribute));
    else
      part.attributes[place->second] = std::move(attribute);
    if (part.attributes.size() > kAttributes) cursor.damaged();
  }
  return !part.attributes.empty();
}

// Bytes of all pixels a part claims; at least one tile, because readers allocate whole tiles.
double claimed_bytes(const Part& part, const RawPart& raw) {
  double pixels = double(part.data_window.pixels());
  pixels = std::max(pixels, double(raw.tiling.width) * double(raw.tiling.height));
  double bytes = 0;
  for (const Channel& channel : part.channels)
    bytes += pixels * double(bytes_per_pixel(channel.type)) / (double(channel.x_sampling) * double(channel.y_sampling));
  return bytes;
}

void check_claims(const Container& container, const ReadLimits& limits) {
  double claimed = 0;
  for (std::size_t i = 0; i < container.raw.size(); ++i) {
    const Part& part = container.header.parts[i];
    // Deflate cannot beat 1032:1, run lengths and PIZ stay below it; DWA stores a black block of 64 pixels in almost
    // nothing and reaches 40 000:1.
    const bool dwa = part.compression == Compression::dwaa || part.compression == Compression::dwab;
    // Of deep parts a count for each pixel; what samples claim is checked chunk by chunk.
    claimed +=
        is_deep(part) ? 4 * double(part.data_window.pixels()) : claimed_bytes(part, container.raw[i]) / (dwa ? 32 : 1);
  }
  if (!(claimed <= limits.inflation * double(container.file.size())))
    throw Failure(ExitCode::input, "'" + container.file.path() + "' claims far more pixels than its " +
                                       std::to_string(container.file.size()) +
                                       " bytes can hold; it is cut off or made to exhaust memory");
}

void check_names(const Container& container) {
  std::set<std::string> seen;
  for (const Part& part : container.header.parts) {
    if (!container.multi_part) return;
    const bool fresh = seen.insert(part.name).second;
    if (part.name.empty() || !fresh)
      throw Failure(ExitCode::input,
                    "'" + container.file.path() + "' has " +
                        (part.name.empty() ? "a part without a name" : "two parts named '" + part.name + "'") +
                        "; render it again with a name for each part");
  }
}

// Puts the chunk tables behind the headers and checks that the file reaches that far.
void place_tables(Container& container, std::uint64_t offset) {
  for (RawPart& part : container.raw) {
    part.table_offset = offset;
    const RawAttribute* count = part.find("chunkCount");
    const bool lies = count && count->type == "int" && count->value.size() == 4 && container.multi_part &&
                      std::uint64_t(load<std::uint32_t>(count->value.data())) != part.chunks;
    if (lies || part.chunks > container.file.size() / 8 || offset + 8 * part.chunks > container.file.size())
      throw Failure(ExitCode::input, "'" + container.file.path() +
                                         (lies ? "' has a chunk count that does not fit its data window"
                                               : "' is cut off in its chunk table; render or copy it again"));
    offset += 8 * part.chunks;
  }
  container.data_offset = offset;
}

}  // namespace

const RawAttribute* RawPart::find(std::string_view name) const {
  for (const RawAttribute& attribute : attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

void RawPart::set(const std::string& name, const std::string& type, std::string value) {
  for (RawAttribute& attribute : attributes)
    if (attribute.name == name) {
      attribute.type = type;
      attribute.value = std::move(value);
      return;
    }
  attributes.push_back({name, type, std::move(value)});
}

void RawPart::remove(std::string_view name) {
  std::erase_if(attributes, [&](const RawAttribute& attribute) { return attribute.name == name; });
}

Container open_container(InputBytes file, const ReadLimits& limits) {
  Container container{std::move(file), false, {}, {}, 0};
  const std::string& path = container.file.path();
  char magic[8] = {};
  if (container.file.size() == 0) throw Failure(ExitCode::input, "'" + path + "' is empty");
  if (container.file.read_some(0, magic, sizeof magic) < sizeof magic || load<std::uint32_t>(magic) != kMagic)
    throw Failure(ExitCode::input, "'" + path + "' is not an OpenEXR file");
  const std::uint32_t version = load<std::uint32_t>(magic + 4), flags = version & ~std::uint32_t(255);
  if ((version & 255) != 2 || (flags & ~(kTiledFlag | kLongNamesFlag | kDeepFlag | kMultiPartFlag)) != 0)
    throw Failure(ExitCode::input, "'" + path + "' is an OpenEXR file of a version unknown to this program");
  container.multi_part = (flags & kMultiPartFlag) != 0;
  container.header.path = path;
  container.header.file_bytes = container.file.size();

  HeaderCursor cursor(container.file);
  cursor.bytes(8);
  for (RawPart raw; read_attributes(cursor, raw); raw = {}) {
    if (container.raw.size() >= std::size_t(limits.parts))
      throw Failure(ExitCode::input, "'" + path + "' has more than " + std::to_string(limits.parts) + " parts");
    try {
      container.header.parts.push_back(decode_part(raw, flags, limits));
    } catch (const Failure&) {
      throw;
    } catch (const std::runtime_error& reason) {
      throw Failure(ExitCode::input, "'" + path + "' cannot be used: " + reason.what());
    }
    const RawAttribute* views = raw.find("multiView");
    if (views && views->type == "stringvector" && container.header.multi_view.empty())
      container.header.multi_view = decode_strings(views->value);
    container.raw.push_back(std::move(raw));
    if (!container.multi_part) break;
  }
  if (container.raw.empty()) throw Failure(ExitCode::input, "'" + path + "' has no part");
  check_names(container);
  place_tables(container, cursor.offset());
  check_claims(container, limits);
  return container;
}

Container open_container(InputBytes file) {
  ReadLimits none;
  none.pixels_per_part = none.tile_pixels = std::numeric_limits<std::uint64_t>::max();
  none.edge = std::numeric_limits<int>::max() / 8;  // a row of pixels still counts its bytes in an int
  none.parts = none.channels = std::numeric_limits<int>::max();
  none.inflation = std::numeric_limits<double>::infinity();
  return open_container(std::move(file), none);
}

std::vector<std::uint64_t> read_chunk_table(const Container& container, int part) {
  const RawPart& raw = container.raw[std::size_t(part)];
  std::vector<std::uint64_t> offsets(raw.chunks);
  container.file.read(raw.table_offset, offsets.data(), offsets.size() * sizeof offsets[0], "chunk table");
  for (std::uint64_t offset : offsets) {
    if (offset == 0)
      throw Failure(ExitCode::input,
                    part_in_words(container.header, part) +
                        " is incomplete: some of its scan lines or tiles were never written; render it again");
    if (offset < container.data_offset || offset >= container.file.size())
      throw Failure(ExitCode::input,
                    part_in_words(container.header, part) +
                        " is cut off: its chunk table points outside the file; render or copy it again");
  }
  return offsets;
}

std::string part_in_words(const FileHeader& header, int part) {
  if (header.parts.size() == 1) return "'" + header.path + "'";
  const std::string& name = header.parts[std::size_t(part)].name;
  return "part " + (name.empty() ? std::to_string(part) : "'" + name + "'") + " of '" + header.path + "'";
}

}  // namespace varve
