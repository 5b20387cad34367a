#include "stages/bitmap_font.h"

#include <algorithm>
#include <iterator>

namespace varve {
namespace {

/// One octal digit per row, top first; its bits are the cells, left first.
struct Glyph {
  char character;
  int rows;
};

constexpr Glyph kGlyphs[] = {{'A', 025755}, {'B', 065656}, {'C', 034443}, {'D', 065556}, {'E', 074647}, {'F', 074644},
                             {'G', 034553}, {'H', 055755}, {'I', 072227}, {'J', 011152}, {'K', 055655}, {'L', 044447},
                             {'M', 057755}, {'N', 075555}, {'O', 025552}, {'P', 065644}, {'Q', 025563}, {'R', 065655},
                             {'S', 034216}, {'T', 072222}, {'U', 055557}, {'V', 055552}, {'W', 055775}, {'X', 055255},
                             {'Y', 055222}, {'Z', 071247}, {'0', 075557}, {'1', 026227}, {'2', 071747}, {'3', 071717},
                             {'4', 055711}, {'5', 074717}, {'6', 074757}, {'7', 071122}, {'8', 075757}, {'9', 075717},
                             {'.', 000002}, {',', 000024}, {'-', 000700}, {'+', 002720}, {'=', 007070}, {'/', 011244},
                             {'%', 051245}, {'(', 012221}, {')', 042224}, {':', 002020}, {'*', 005250}, {'<', 012421},
                             {'>', 042124}, {'_', 000007}, {'\'', 022000}};

}  // namespace

bool glyph_cell(char character, int x, int y) {
  if (character >= 'a' && character <= 'z') character = char(character - 'a' + 'A');
  const auto glyph = std::ranges::find(kGlyphs, character, &Glyph::character);
  if (glyph == std::end(kGlyphs) || x < 0 || x >= kGlyphWidth || y < 0 || y >= kGlyphHeight) return false;
  return (glyph->rows >> (3 * (kGlyphHeight - 1 - y) + kGlyphWidth - 1 - x) & 1) != 0;
}

}  // namespace varve
