#include "resolve/k_dop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace varve {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

constexpr std::array<glm::dvec3, 13> kDirections = {
    glm::dvec3(1, 0, 0),  glm::dvec3(0, 1, 0),  glm::dvec3(0, 0, 1), glm::dvec3(1, 1, 1), glm::dvec3(1, 1, -1),
    glm::dvec3(1, -1, 1), glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, 0), glm::dvec3(1, 0, 1), glm::dvec3(0, 1, 1),
    glm::dvec3(1, -1, 0), glm::dvec3(1, 0, -1), glm::dvec3(0, 1, -1)};

/// A face that holds the point back: outward unit normal and how strongly.
struct Active {
  glm::dvec3 normal;
  double push;
};

/// The faces that hold back, at most three, and the split of a further normal: its part along theirs as coefficients,
/// and the rest.
struct ActiveSet {
  std::array<Active, 3> faces;
  int count = 0;

  glm::dvec3 split(const glm::dvec3& n, std::array<double, 3>& along) const {
    // Orthogonalized in order, twice for the digits, then solved backwards.
    std::array<glm::dvec3, 3> basis{};
    double r[3][3] = {};
    for (int j = 0; j < count; ++j) {
      glm::dvec3 b = faces[std::size_t(j)].normal;
      for (int i = 0; i < j; ++i) {
        r[i][j] = glm::dot(basis[std::size_t(i)], b);
        b -= basis[std::size_t(i)] * r[i][j];
      }
      r[j][j] = glm::length(b);
      basis[std::size_t(j)] = b / r[j][j];
    }
    glm::dvec3 rest = n;
    double on[3] = {};
    for (int j = 0; j < count; ++j) {
      on[j] = glm::dot(basis[std::size_t(j)], rest);
      rest -= basis[std::size_t(j)] * on[j];
    }
    for (int j = count - 1; j >= 0; --j) {
      double value = on[j];
      for (int i = j + 1; i < count; ++i) value -= r[j][i] * along[std::size_t(i)];
      along[std::size_t(j)] = value / r[j][j];
    }
    return rest;
  }
  void drop(int j) {
    for (; j + 1 < count; ++j) faces[std::size_t(j)] = faces[std::size_t(j + 1)];
    --count;
  }
};

struct Face {
  glm::dvec3 normal{0};
  double beyond = 0;  // how far the point lies outside
};

Face worst_face(const KDop& dop, const glm::dvec3& x) {
  Face worst;
  for (std::size_t i = 0; i < std::size_t(dop.directions); ++i) {
    const double length = glm::length(kDirections[i]), at = glm::dot(kDirections[i], x);
    if ((at - dop.high[i]) / length > worst.beyond) worst = {kDirections[i] / length, (at - dop.high[i]) / length};
    if ((dop.low[i] - at) / length > worst.beyond) worst = {-kDirections[i] / length, (dop.low[i] - at) / length};
  }
  return worst;
}

/// Moves x onto the face; faces that would hold it from behind are let go.
void move_onto(const Face& face, ActiveSet& active, glm::dvec3& x) {
  double left = face.beyond, push = 0;
  for (int step = 0; step < 4; ++step) {
    std::array<double, 3> along{};
    const glm::dvec3 free = active.split(face.normal, along);
    const double free2 = glm::dot(free, free);
    double release = kNone;
    int first = -1;
    for (int j = 0; j < active.count; ++j)
      if (along[std::size_t(j)] > 0 && active.faces[std::size_t(j)].push / along[std::size_t(j)] < release)
        release = active.faces[std::size_t(j)].push / along[std::size_t(j)], first = j;
    const double full = free2 > 1e-12 && active.count < 3 ? left / free2 : kNone;
    const double go = std::min(release, full);
    if (!(go < kNone)) return;
    for (int j = 0; j < active.count; ++j) active.faces[std::size_t(j)].push -= go * along[std::size_t(j)];
    push += go;
    if (full < kNone) x -= free * go, left -= go * free2;
    if (full <= release) {
      active.faces[std::size_t(active.count++)] = {face.normal, push};
      return;
    }
    active.drop(first);
  }
}

}  // namespace

KDop make_k_dop(const Samples& samples, int directions, double floor) {
  KDop dop;
  dop.directions = directions;
  for (std::size_t i = 0; i < std::size_t(directions); ++i) {
    dop.low[i] = kNone;
    dop.high[i] = -kNone;
    for (const glm::dvec4& c : samples) {
      const double at = glm::dot(kDirections[i], glm::dvec3(c));
      dop.low[i] = std::min(dop.low[i], at);
      dop.high[i] = std::max(dop.high[i], at);
    }
    dop.low[i] -= floor * glm::length(kDirections[i]);
    dop.high[i] += floor * glm::length(kDirections[i]);
  }
  return dop;
}

double KDop::crossing(const glm::dvec3& g, const glm::dvec3& h) const {
  double t = 1;
  for (std::size_t i = 0; i < std::size_t(directions); ++i) {
    const double from = glm::dot(kDirections[i], g), to = glm::dot(kDirections[i], h);
    const double bound = to > high[i] ? high[i] : low[i];
    if (to > high[i] || to < low[i]) t = from == to ? 0 : std::min(t, (bound - from) / (to - from));
  }
  return std::max(t, 0.0);
}

glm::dvec3 KDop::nearest(const glm::dvec3& h) const {
  glm::dvec3 x = h;
  ActiveSet active;
  double size = 0;
  for (std::size_t i = 0; i < std::size_t(directions); ++i)
    size = std::max({size, std::abs(low[i]), std::abs(high[i]), std::abs(glm::dot(kDirections[i], h))});
  for (int face = 0; face < 64; ++face) {
    const Face worst = worst_face(*this, x);
    if (!(worst.beyond > 1e-13 * size)) break;
    move_onto(worst, active, x);
  }
  return x;
}

}  // namespace varve
