#include "stages/state_file.h"

#include <libdeflate.h>

#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "exr/header_bytes.h"
#include "exr/input_bytes.h"
#include "exr/output_bytes.h"
#include "stages/state_planes.h"

namespace varve {
namespace {

constexpr std::string_view kMagic = "varve-st";
constexpr std::uint64_t kPreamble = 24;  // bytes before the head
constexpr std::size_t kMostSubjects = 16384;
constexpr std::int64_t kLargest = 1 << 21;  // pixels, of a coordinate: twice what images may have

/// What an element of a plane is.
enum class Element : std::uint8_t { float1 = 1, float2, float3, float4, uint32, byte, double2, int32 };

template <class T>
constexpr Element element_of() {
  if constexpr (std::is_same_v<T, float>) return Element::float1;
  if constexpr (std::is_same_v<T, glm::vec2>) return Element::float2;
  if constexpr (std::is_same_v<T, glm::vec3>) return Element::float3;
  if constexpr (std::is_same_v<T, glm::vec4>) return Element::float4;
  if constexpr (std::is_same_v<T, std::uint32_t>) return Element::uint32;
  if constexpr (std::is_same_v<T, std::uint8_t>) return Element::byte;
  if constexpr (std::is_same_v<T, glm::dvec2>) return Element::double2;
  if constexpr (std::is_same_v<T, std::int32_t>) return Element::int32;
}

/// One piece of the file behind the head.
struct Record {
  std::string name;
  Element element = Element::byte;
  Window window;  ///< of a plane; of a list, its length by 1
  std::uint32_t crc = 0;
};

std::uint32_t crc_of(const void* bytes, std::size_t count) { return libdeflate_crc32(0, bytes, count); }

/// piece(name, leaf) for everything of all states.
template <class States, class Piece>
void each_piece(States& states, const Piece& piece) {
  for (std::size_t k = 0; k < states.size(); ++k)
    visit_leaves(states[k], std::to_string(k) + "/", [&](const std::string& name, auto& leaf) { piece(name, leaf); });
}

// --- out ---

void append_text(std::string& to, const std::string& text) {
  append(to, std::uint32_t(text.size()));
  to += text;
}

void append_cameras(std::string& to, const FrameCameras& cameras) {
  append(to, std::uint32_t(cameras.cameras.size()));
  for (std::size_t k = 0; k < cameras.cameras.size(); ++k) {
    append(to, std::uint8_t(cameras.cameras[k].has_value()));
    if (cameras.cameras[k]) {
      const Camera& camera = *cameras.cameras[k];
      append(to, std::uint8_t(camera.projection));
      append(to, camera.to_camera);
      append(to, camera.focal);
      append(to, camera.center);
    }
    append(to, std::uint8_t(cameras.jitter[k].has_value()));
    if (cameras.jitter[k]) append(to, *cameras.jitter[k]);
  }
}

/// Rows of one piece, handed out one after the other.
template <class T, class Take>
void rows_of(const std::string& name, const Plane<T>& plane, const Take& take) {
  if (plane.empty()) return;
  std::vector<std::span<const T>> rows;
  const Window& w = plane.window();
  for (int y = w.y0; y < w.y1; ++y) rows.emplace_back(plane.row(y), std::size_t(w.width()));
  take(name, w, rows);
}
template <class T, class Take>
void rows_of(const std::string& name, const std::vector<Plane<T>>& planes, const Take& take) {
  for (std::size_t i = 0; i < planes.size(); ++i) rows_of(name + "/" + std::to_string(i), planes[i], take);
}
template <class Take>
void rows_of(const std::string& name, const std::vector<std::uint8_t>& bytes, const Take& take) {
  const std::vector<std::span<const std::uint8_t>> rows = {bytes};
  if (!bytes.empty()) take(name, Window{0, 0, int(bytes.size()), 1}, rows);
}
template <class T, class Take>
requires std::same_as<T, glm::dvec2> || std::same_as<T, std::int32_t>
void rows_of(const std::string& name, const T& number, const Take& take) {
  const std::vector<std::span<const T>> rows = {{&number, 1}};
  take(name, Window{0, 0, 1, 1}, rows);
}

std::string head_bytes(const StateHead& head, const std::vector<SubjectState>& subjects) {
  std::string bytes;
  for (const std::string* text : {&head.version, &head.parameters, &head.hash}) append_text(bytes, *text);
  append(bytes, std::int32_t(head.first));
  append(bytes, std::int32_t(head.preroll));
  append(bytes, std::uint32_t(head.frames.size()));
  for (const UsedFrame& used : head.frames) {
    append(bytes, std::int32_t(used.frame));
    append(bytes, used.print);
  }
  append(bytes, std::uint32_t(head.subjects.size()));
  for (const std::string& subject : head.subjects) append_text(bytes, subject);
  append_cameras(bytes, head.cameras);
  std::string records;
  std::uint32_t count = 0;
  each_piece(subjects, [&](const std::string& leaf, const auto& member) {
    rows_of(leaf, member, [&](const std::string& name, const Window& window, const auto& rows) {
      using T = typename std::remove_cvref_t<decltype(rows)>::value_type::value_type;
      std::uint32_t crc = crc_of(nullptr, 0);
      for (const auto& row : rows) crc = libdeflate_crc32(crc, row.data(), row.size_bytes());
      append_text(records, name);
      append(records, std::uint8_t(element_of<T>()));
      for (const int edge : {window.x0, window.y0, window.x1, window.y1}) append(records, std::int32_t(edge));
      append(records, crc);
      ++count;
    });
  });
  append(bytes, count);
  return bytes + records;
}

// --- in ---

[[noreturn]] void damaged(const std::string& path, const std::string& what) {
  throw Failure(ExitCode::input, "the state file '" + path + "' " + what + "; run the chunk before it again");
}

/// Walks the head; what is not there is never allocated.
class HeadCursor {
 public:
  HeadCursor(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  template <class T>
  T number() {
    need(sizeof(T));
    const T value = load<T>(bytes_.data() + at_);
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const std::uint32_t size = number<std::uint32_t>();
    need(size);
    std::string value = bytes_.substr(at_, size);
    at_ += size;
    return value;
  }
  /// How many things follow that take at least `bytes` each.
  std::size_t count(std::size_t bytes) {
    const std::uint32_t n = number<std::uint32_t>();
    need(std::size_t(n) * bytes);
    return n;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  void need(std::size_t count) const {
    if (count > bytes_.size() - at_) damaged(path_, "is damaged in its head");
  }
  const std::string& bytes_;
  const std::string& path_;
  std::size_t at_ = 0;
};

FrameCameras read_cameras(HeadCursor& cursor) {
  FrameCameras cameras;
  for (std::size_t n = cursor.count(2); n > 0; --n) {
    std::optional<Camera>& camera = cameras.cameras.emplace_back();
    if (cursor.number<std::uint8_t>() != 0) {
      const bool flat = cursor.number<std::uint8_t>() == std::uint8_t(Projection::orthographic);
      camera = Camera{flat ? Projection::orthographic : Projection::perspective, cursor.number<glm::dmat4>(),
                      cursor.number<glm::dvec2>(), cursor.number<glm::dvec2>()};
    }
    std::optional<glm::dvec2>& jitter = cameras.jitter.emplace_back();
    if (cursor.number<std::uint8_t>() != 0) jitter = cursor.number<glm::dvec2>();
  }
  return cameras;
}

constexpr std::uint64_t bytes_of(Element element) {
  constexpr std::uint64_t sizes[] = {0, 4, 8, 12, 16, 4, 1, 16, 4};
  return sizes[std::size_t(element)];
}

std::uint64_t bytes_of(const Record& record) {
  return std::uint64_t(record.window.pixels()) * bytes_of(record.element);
}

struct Opened {
  InputBytes file;
  StateHead head;
  std::vector<Record> records;
  std::uint64_t data = 0;  ///< where the first piece lies
};

Record read_record(HeadCursor& cursor, const std::string& path) {
  Record record;
  record.name = cursor.text();
  const std::uint8_t element = cursor.number<std::uint8_t>();
  std::int64_t edges[4];
  bool sane = element >= 1 && element <= std::uint8_t(Element::int32);
  for (std::int64_t& edge : edges) {
    edge = cursor.number<std::int32_t>();
    sane = sane && edge >= -kLargest && edge <= kLargest;
  }
  record.window = {int(edges[0]), int(edges[1]), int(edges[2]), int(edges[3])};
  record.element = Element(element);
  record.crc = cursor.number<std::uint32_t>();
  if (!sane || record.window.empty()) damaged(path, "is damaged in its head");
  return record;
}

Opened open_state(const std::string& path) {
  Opened state{InputBytes(path), {}, {}, 0};
  char preamble[kPreamble];
  if (state.file.read_some(0, preamble, kPreamble) != kPreamble || std::string_view(preamble, 8) != kMagic)
    throw Failure(ExitCode::input,
                  "'" + path + "' is not a state file; name one that --state-out has written with --state-in");
  const std::uint32_t format = load<std::uint32_t>(preamble + 8), crc = load<std::uint32_t>(preamble + 12);
  if (format != kStateFormat)
    throw Failure(ExitCode::inconsistent, "the state file '" + path + "' has format " + std::to_string(format) +
                                              ", and this program reads format " + std::to_string(kStateFormat) +
                                              "; run the chunk before it again with this program");
  const std::uint64_t size = load<std::uint64_t>(preamble + 16);
  if (size > state.file.size() - kPreamble) damaged(path, "is cut off");
  std::string bytes(std::size_t(size), '\0');
  state.file.read(kPreamble, bytes.data(), bytes.size(), "head");
  if (crc_of(bytes.data(), bytes.size()) != crc) damaged(path, "is damaged in its head");

  HeadCursor cursor(bytes, path);
  StateHead& head = state.head;
  for (std::string* text : {&head.version, &head.parameters, &head.hash}) *text = cursor.text();
  head.first = cursor.number<std::int32_t>();
  head.preroll = cursor.number<std::int32_t>();
  for (std::size_t n = cursor.count(12); n > 0; --n) {
    const int frame = cursor.number<std::int32_t>();
    head.frames.push_back({frame, cursor.number<std::uint64_t>()});
  }
  for (std::size_t n = cursor.count(4); n > 0; --n) head.subjects.push_back(cursor.text());
  head.cameras = read_cameras(cursor);
  std::uint64_t left = state.file.size() - kPreamble - size;
  for (std::size_t n = cursor.count(25); n > 0; --n) {
    state.records.push_back(read_record(cursor, path));
    const std::uint64_t piece = bytes_of(state.records.back());
    if (piece > left) damaged(path, "is cut off");
    left -= piece;
  }
  if (!cursor.at_end() || left != 0 || head.frames.empty() || head.subjects.size() > kMostSubjects)
    damaged(path, "is damaged");
  state.data = kPreamble + size;
  return state;
}

/// Pieces by name, each to be taken once.
class Pieces {
 public:
  Pieces(const Opened& state, const std::string& path) : state_(state), path_(path) {
    std::uint64_t at = state.data;
    for (const Record& record : state.records) {
      if (!places_.emplace(record.name, Place{&record, at}).second) damaged(path, "has a plane twice");
      at += bytes_of(record);
    }
  }
  template <class T>
  void fill(const std::string& name, Plane<T>& plane) {
    const std::optional<Place> place = take(name, element_of<T>());
    if (!place) return;
    plane = Plane<T>(place->record->window);
    const Window& w = plane.window();
    std::uint32_t crc = crc_of(nullptr, 0);
    std::uint64_t at = place->at;
    for (int y = w.y0; y < w.y1; ++y) {
      const std::size_t bytes = sizeof(T) * std::size_t(w.width());
      state_.file.read(at, plane.row(y), bytes, "planes");
      crc = libdeflate_crc32(crc, plane.row(y), bytes);
      at += bytes;
    }
    check(crc, *place);
  }
  template <class T>
  void fill(const std::string& name, std::vector<Plane<T>>& planes) {
    for (std::string one = name + "/0"; places_.contains(one); one = name + "/" + std::to_string(planes.size()))
      fill(one, planes.emplace_back());
  }
  void fill(const std::string& name, std::vector<std::uint8_t>& bytes) {
    const std::optional<Place> place = take(name, Element::byte);
    if (!place) return;
    bytes.resize(place->record->window.pixels());
    read_all(*place, bytes.data(), bytes.size());
  }
  template <class T>
  requires std::same_as<T, glm::dvec2> || std::same_as<T, std::int32_t>
  void fill(const std::string& name, T& number) {
    if (const std::optional<Place> place = take(name, element_of<T>())) {
      if (place->record->window.pixels() != 1) damaged(path_, "is damaged");
      read_all(*place, &number, sizeof number);
    }
  }
  bool all_taken() const { return places_.empty(); }

 private:
  struct Place {
    const Record* record;
    std::uint64_t at;
  };
  std::optional<Place> take(const std::string& name, Element element) {
    const auto found = places_.find(name);
    if (found == places_.end()) return std::nullopt;
    const Place place = found->second;
    places_.erase(found);
    if (place.record->element != element) damaged(path_, "is damaged in plane '" + name + "'");
    return place;
  }
  void read_all(const Place& place, void* to, std::size_t bytes) const {
    state_.file.read(place.at, to, bytes, "planes");
    check(crc_of(to, bytes), place);
  }
  void check(std::uint32_t crc, const Place& place) const {
    if (crc != place.record->crc) damaged(path_, "is damaged in plane '" + place.record->name + "'");
  }

  const Opened& state_;
  const std::string& path_;
  std::map<std::string, Place> places_;
};

bool is_finite(const Plane<glm::vec4>& plane) {
  const Window& w = plane.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const glm::vec4& p = plane.at(x, y);
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.w))) return false;
    }
  return true;
}
bool is_weight(const Plane<float>& plane) {
  const Window& w = plane.window();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x)
      if (!(plane.at(x, y) >= 0 && std::isfinite(plane.at(x, y)))) return false;
  return true;
}

bool has_shape(const SubpixelBuffer& b) {
  const Window& w = b.color.window();
  bool good = b.lag >= 0 && (b.empty() || (!b.total.empty() && !b.spread.empty() && !b.moments.empty()));
  const auto like = [&](const auto& plane) { good = good && (plane.empty() || plane.window() == w); };
  like(b.total), like(b.spread), like(b.moments), like(b.depth), like(b.id), like(b.normal);
  for (const Plane<glm::vec4>& companion : b.companions) like(companion), good = good && !companion.empty();
  if (!good) return false;
  for (const Plane<glm::vec4>& companion : b.companions) good = good && is_finite(companion);
  return good && is_finite(b.color) && is_weight(b.total) && is_weight(b.spread);
}

/// The planes of a frame share its window, and what is averaged is finite: checksums can be made to fit.
bool has_shape(const SubjectState& state) {
  const History& h = state.history;
  const Window& w = h.color.window();
  bool good = true;
  const auto like = [&](const auto& plane, const Window& window) {
    good = good && (plane.empty() || plane.window() == window);
  };
  if (!h.empty()) good = !h.total.empty() && !h.spread.empty() && h.rows_valid.size() == std::size_t(w.height());
  like(h.total, w), like(h.spread, w), like(h.depth, w), like(h.motion, w), like(h.id, w), like(h.normal, w);
  like(h.remainder, w), like(h.blur, w);
  for (const Plane<glm::vec4>& companion : h.companions) like(companion, w), good = good && !companion.empty();
  like(state.forward.depth, state.forward.motion.window());
  const SeenPlanes& seen = state.forward.seen;
  like(seen.depth, seen.light.window()), like(seen.id, seen.light.window());
  if (!good) return false;
  for (const Plane<glm::vec4>& companion : h.companions) good = good && is_finite(companion);
  for (const SubpixelBuffer& quadrant : state.subpixel.quadrants) good = good && has_shape(quadrant);
  return good && is_finite(h.color) && (h.remainder.empty() || is_finite(h.remainder)) && is_weight(h.total) &&
         is_weight(h.spread);
}

}  // namespace

void write_state(const std::string& path, const StateHead& head, const std::vector<SubjectState>& subjects) {
  check_writable(path);
  const std::string bytes = head_bytes(head, subjects);
  std::string preamble(kMagic);
  append(preamble, kStateFormat);
  append(preamble, crc_of(bytes.data(), bytes.size()));
  append(preamble, std::uint64_t(bytes.size()));
  OutputBytes file(path);
  file.append(preamble.data(), preamble.size());
  file.append(bytes.data(), bytes.size());
  std::vector<char> block;  // rows are short; the disk likes it long
  each_piece(subjects, [&](const std::string& leaf, const auto& member) {
    rows_of(leaf, member, [&](const std::string&, const Window&, const auto& rows) {
      for (const auto& row : rows) {
        const char* from = reinterpret_cast<const char*>(row.data());
        block.insert(block.end(), from, from + row.size_bytes());
        if (block.size() < std::size_t(1) << 20) continue;
        file.append(block.data(), block.size());
        block.clear();
      }
    });
  });
  file.append(block.data(), block.size());
  file.commit();
}

bool is_free_for_state(const std::string& path) {
  if (!identity_of(path).there) return true;
  char magic[kMagic.size()];
  return InputBytes(path).read_some(0, magic, sizeof magic) == sizeof magic &&
         std::string_view(magic, sizeof magic) == kMagic;
}

StateHead read_state_head(const std::string& path) { return std::move(open_state(path).head); }

SavedState read_state(const std::string& path) {
  Opened opened = open_state(path);
  SavedState state;
  state.subjects.resize(opened.head.subjects.size());
  Pieces pieces(opened, path);
  each_piece(state.subjects, [&](const std::string& name, auto& member) { pieces.fill(name, member); });
  if (!pieces.all_taken()) damaged(path, "has planes that nobody asked for");
  for (const SubjectState& subject : state.subjects)
    if (!has_shape(subject)) damaged(path, "holds planes that do not fit together, or values that are not finite");
  state.head = std::move(opened.head);
  return state;
}

}  // namespace varve
