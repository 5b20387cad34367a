#include <algorithm>
#include <array>

#include "fuzz/targets.h"

namespace varve::fuzz {
namespace {

std::size_t below(Random& random, std::size_t n) { return n == 0 ? 0 : std::size_t(random() % n); }

constexpr std::array<std::string_view, 44> kPieces = {"0",
                                                      "-1",
                                                      "1e308",
                                                      "1e999",
                                                      "-1e-320",
                                                      "nan",
                                                      "inf",
                                                      "2147483647",
                                                      "-2147483648",
                                                      "2147483648",
                                                      "99999999999999999999",
                                                      "0x10",
                                                      "1-10",
                                                      "-5--1",
                                                      "1-10x2",
                                                      ",",
                                                      ",,",
                                                      ":",
                                                      "=",
                                                      "#",
                                                      "####",
                                                      "%04d",
                                                      "%99d",
                                                      "$F4",
                                                      "@@@",
                                                      "\n",
                                                      "\r\n",
                                                      "\"",
                                                      "\\u0000",
                                                      "\\ud800",
                                                      "[",
                                                      "]",
                                                      "{",
                                                      "}",
                                                      "null",
                                                      "true",
                                                      "\xEF\xBB\xBF",
                                                      "\xff",
                                                      " ",
                                                      "frame",
                                                      "--",
                                                      "each",
                                                      "grid:2",
                                                      "."};

void damage_once(std::string& text, Random& random) {
  const std::size_t at = below(random, text.size() + 1), left = text.size() - at;
  const std::size_t length = std::min(left, 1 + below(random, 12));
  switch (below(random, 8)) {
    case 0:
      if (left > 0) text[at] = char(random());
      return;
    case 1:
      if (left > 0) text[at] = char(text[at] ^ (1 << below(random, 8)));
      return;
    case 2:
      text.insert(at, kPieces[below(random, kPieces.size())]);
      return;
    case 3:
      text.erase(at, length);
      return;
    case 4:
      text.insert(below(random, text.size() + 1), text.substr(at, length));
      return;
    case 5: {  // what stands between two separators, by something else
      const std::size_t from = text.find_first_of("0123456789-.", at);
      if (from == std::string::npos) return;
      const std::size_t end = std::min(text.find_first_not_of("0123456789-.e+", from), text.size());
      text.replace(from, end - from, kPieces[below(random, kPieces.size())]);
      return;
    }
    case 6: {
      const std::string piece = text.substr(at, length);
      for (std::size_t i = below(random, 40); i > 0; --i) text.insert(at, piece);
      return;
    }
    default:
      text.resize(at);
  }
}

}  // namespace

std::string mutate_text(const std::string& bytes, Random& random) {
  std::string damaged = bytes;
  for (std::size_t times = 1 + below(random, 3) * below(random, 2); times > 0; --times) damage_once(damaged, random);
  return damaged;
}

}  // namespace varve::fuzz
