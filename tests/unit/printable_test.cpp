#include "base/printable.h"

#include <gtest/gtest.h>

namespace varve {
namespace {

TEST(Printable, ControlCharactersAreShownAsWhatTheyAre) {
  EXPECT_EQ(printable("plain 'text', \xc3\xa9"), "plain 'text', \xc3\xa9");
  EXPECT_EQ(printable(std::string("a\n\t\x1b[2J\x7f\0", 9)), "a\\n\\t\\x1b[2J\\x7f\\x00");
  EXPECT_EQ(printable_lines("a\x01\n\nb\r\n"), "a\\x01\n\nb\\x0d\n");
  EXPECT_EQ(printable_lines(""), "");
}

}  // namespace
}  // namespace varve
