#include "diagnose/color_print.h"

#include <cstring>
#include <vector>

namespace varve {
namespace {

/// Multiply and fold: every bit of `more` reaches every bit of the result within two rounds.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t more) {
  hash = (hash ^ more) * 0x9E3779B97F4A7C15ull;
  return hash ^ (hash >> 29);
}

}  // namespace

std::uint64_t color_print(const Plane<glm::vec4>& color, Workers& workers) {
  const Window& w = color.window();
  if (w.empty()) return 0;
  struct Row {
    std::uint64_t hash = 0;
    bool flat = true;
  };
  std::vector<Row> rows(std::size_t(w.height()));
  const glm::vec4* corner = color.row(w.y0);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    Row& row = rows[std::size_t(y - w.y0)];
    for (int x = 0; x < w.width(); ++x) {
      std::uint64_t bits[2];
      static_assert(sizeof bits == sizeof(glm::vec4));
      std::memcpy(bits, color.row(y) + x, sizeof bits);
      row.hash = mixed(mixed(row.hash, bits[0]), bits[1]);
      row.flat = row.flat && std::memcmp(color.row(y) + x, corner, sizeof bits) == 0;
    }
  });
  bool flat = true;
  std::uint64_t hash =
      mixed(mixed(std::uint64_t(w.width()), std::uint64_t(std::uint32_t(w.x0))), std::uint64_t(std::uint32_t(w.y0)));
  for (const Row& row : rows) {
    hash = mixed(hash, row.hash);
    flat = flat && row.flat;
  }
  return flat ? 0 : hash == 0 ? 1 : hash;
}

}  // namespace varve
