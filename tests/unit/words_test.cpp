// Text taken apart and put together.
#include "base/words.h"

#include <gtest/gtest.h>

namespace varve {
namespace {

TEST(Words, FieldsAreTrimmedAndNoneIsLost) {
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \t\r\n"), "");
  EXPECT_EQ(split_at_commas(" 1 ,,2,"), (std::vector<std::string_view>{"1", "", "2", ""}));
  EXPECT_EQ(split_at_commas(""), (std::vector<std::string_view>{""}));
}

TEST(Words, LinesBreakAtBlanksAndKeepEveryWord) {
  const std::string word(30, 'x'), long_word(200, 'y');
  EXPECT_EQ(wrapped("- ", word + " " + word + " " + word + " " + word),
            "- " + word + " " + word + " " + word + "\n  " + word + "\n");
  EXPECT_EQ(wrapped("- ", long_word + " z"), "- " + long_word + "\n  z\n");  // never inside a word
  EXPECT_EQ(wrapped("- ", ""), "-\n");
}

TEST(Words, JsonIsReadBack) {
  const std::vector<int> numbers = {1, 2};
  const std::string text = json_object(
      {{"a\"b", json_array(numbers, [](int i) { return std::to_string(i); })}, {"yes", json_boolean(true)}});
  EXPECT_EQ(text, "{\"a\\\"b\":[1,2],\"yes\":true}");
  const std::optional<JsonValue> value = parse_json(text);
  ASSERT_TRUE(value);
  EXPECT_EQ(value->find("a\"b")->numbers(), (std::vector<double>{1, 2}));
  EXPECT_EQ(json_object({}), "{}");
  EXPECT_EQ(json_array(std::vector<int>(), [](int) { return std::string(); }), "[]");
}

}  // namespace
}  // namespace varve
