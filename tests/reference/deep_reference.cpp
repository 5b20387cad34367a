#include "reference/deep_reference.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace varve::reference {
namespace {

Piece part_of(const Piece& piece, double front, double back) {
  Piece part = piece;
  part.front = front;
  part.back = back;
  if (piece.alpha >= 1) return part;
  const double x = (back - front) / (piece.back - piece.front);
  part.alpha = -std::expm1(x * std::log1p(-piece.alpha));
  part.color = piece.alpha > 0 ? piece.color * part.alpha / piece.alpha : piece.color * x;
  return part;
}

bool coincide(const Piece& a, const Piece& b) { return a.front == b.front && a.back == b.back && a.back > a.front; }

}  // namespace

std::vector<Piece> split(const Piece& piece, double z) {
  return {part_of(piece, piece.front, z), part_of(piece, z, piece.back)};
}

Piece merge(const Piece& a, const Piece& b) {
  Piece merged = a;
  double share = 0.5;  // of b
  if (a.alpha >= 1 && b.alpha >= 1) {
    // The mean of all opaque ones; how many a stands for shows in its shares.
    const auto count = [](const Piece& p) {
      return std::count_if(p.shares.begin(), p.shares.end(), [](double s) { return s > 0; });
    };
    share = double(count(b)) / double(count(a) + count(b));
    merged.color = a.color * (1 - share) + b.color * share;
  } else if (a.alpha >= 1 || b.alpha >= 1) {
    share = b.alpha >= 1 ? 1 : 0;
    merged.color = b.alpha >= 1 ? b.color : a.color;
    merged.alpha = 1;
  } else {
    merged.alpha = a.alpha + b.alpha - a.alpha * b.alpha;
    const double ua = -std::log1p(-a.alpha), ub = -std::log1p(-b.alpha);
    const double w = ua + ub > 0 ? merged.alpha / (ua + ub) : 1;
    merged.color = w * (a.color * (a.alpha > 0 ? ua / a.alpha : 1) + b.color * (b.alpha > 0 ? ub / b.alpha : 1));
    if (ua + ub > 0) share = ub / (ua + ub);
  }
  for (std::size_t i = 0; i < merged.shares.size(); ++i)
    merged.shares[i] = a.shares[i] * (1 - share) + b.shares[i] * share;
  return merged;
}

std::vector<Piece> tidy(std::vector<Piece> pieces) {
  const std::size_t count = pieces.size();
  std::vector<double> cuts;
  for (std::size_t i = 0; i < count; ++i) {
    pieces[i].shares.assign(count, 0);
    pieces[i].shares[i] = 1;
    cuts.push_back(pieces[i].front);
    cuts.push_back(pieces[i].back);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<Piece> small;
  for (const Piece& piece : pieces) {
    // Each piece from the whole one, so that errors do not add up along it.
    double from = piece.front;
    for (const double z : cuts)
      if (z > from && z < piece.back) {
        small.push_back(part_of(piece, from, z));
        from = z;
      }
    small.push_back(from == piece.front ? piece : part_of(piece, from, piece.back));
  }
  std::stable_sort(small.begin(), small.end(), [](const Piece& a, const Piece& b) {
    if (a.front == b.front && a.back == b.back && a.front == a.back) return false;  // points: as they were given
    return std::tie(a.front, a.back, a.alpha, a.color) < std::tie(b.front, b.back, b.alpha, b.color);
  });
  std::vector<Piece> merged;
  for (const Piece& piece : small)
    if (!merged.empty() && coincide(merged.back(), piece))
      merged.back() = merge(merged.back(), piece);
    else
      merged.push_back(piece);
  return merged;
}

Flat flatten(const std::vector<Piece>& tidy_pieces) {
  Flat flat;
  if (!tidy_pieces.empty()) flat.variation.assign(tidy_pieces.front().shares.size(), 0);
  for (const Piece& piece : tidy_pieces) {
    const double change = flat.transmittance * piece.alpha;
    flat.color += flat.transmittance * piece.color;
    flat.alpha += change;
    for (std::size_t i = 0; i < piece.shares.size(); ++i) flat.variation[i] += change * piece.shares[i];
    flat.transmittance *= 1 - piece.alpha;
  }
  return flat;
}

}  // namespace varve::reference
