// What files say of themselves, made fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace varve {

/// Names out of files may hold anything: control characters become \n, \t or \x1b, so that they neither forge lines
/// nor speak to a terminal.
std::string printable(std::string_view text);
/// The same with line breaks kept.
std::string printable_lines(std::string_view text);

}  // namespace varve
