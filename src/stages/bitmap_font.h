// Capital letters, digits and a few signs of 3x5 cells, for labels in pictures.
#pragma once

#include <string_view>

namespace varve {

inline constexpr int kGlyphWidth = 3, kGlyphHeight = 5, kGlyphAdvance = 4;

/// Whether a cell of the character's glyph is inked, x 0..2 from the left, y 0..4 from the top. Small letters look as
/// capital ones do; characters that are not in the font are blank.
bool glyph_cell(char character, int x, int y);

}  // namespace varve
