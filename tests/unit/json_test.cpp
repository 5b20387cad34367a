#include "base/json.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace varve {
namespace {

TEST(Json, ReadsEveryKind) {
  const auto value = parse_json(R"( {"a":[1,-2.5e2,0.0],"b":{"c":null,"d":true},"e":"x\ty\u00e9\ud83d\ude00\/"} )");
  ASSERT_TRUE(value);
  EXPECT_EQ(value->find("a")->numbers(), (std::vector<double>{1, -250, 0}));
  EXPECT_EQ(value->find("b")->find("c")->kind, JsonValue::Kind::null);
  EXPECT_TRUE(value->find("b")->find("d")->boolean);
  EXPECT_EQ(value->find("e")->text, "x\ty\xC3\xA9\xF0\x9F\x98\x80/");
  EXPECT_EQ(value->find("f"), nullptr);
  EXPECT_EQ(value->find("a")->find("a"), nullptr);
  EXPECT_FALSE(value->find("b")->numbers());
}

TEST(Json, RefusesGarbage) {
  for (const char* text : {"",
                           " ",
                           "{",
                           "[1,]",
                           "[1 2]",
                           "{\"a\"}",
                           "{\"a\":}",
                           "{a:1}",
                           "nul",
                           "01",
                           "-",
                           "1.",
                           ".5",
                           "1e",
                           "+1",
                           "NaN",
                           "Infinity",
                           "1e999",
                           "\"",
                           "\"\\x\"",
                           "\"\\u12\"",
                           "\"\\ud800\"",
                           "\"\\udc00x\"",
                           "\"\x01\"",
                           "1 2",
                           "[1]]",
                           "{\"a\":1,}",
                           "'a'",
                           "[1,2",
                           "{\"jitter\":[0.1,0.2]"})
    EXPECT_FALSE(parse_json(text)) << text;
}

TEST(Json, DepthIsLimited) {
  EXPECT_TRUE(parse_json(std::string(32, '[') + std::string(32, ']')));
  EXPECT_FALSE(parse_json(std::string(33, '[') + std::string(33, ']')));
  EXPECT_FALSE(parse_json(std::string(1000000, '[')));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "{\"a\":";
  EXPECT_FALSE(parse_json(deep));
}

TEST(Json, CutAnywhereIsRefusedAndNeverCrashes) {
  const std::string text = R"({"frame":1,"jitter":[0.0,-0.166667],"mode":"j\u00e9t","view":[1.0,-0.0,1e-3],"x":null})";
  ASSERT_TRUE(parse_json(text));
  for (std::size_t i = 0; i < text.size(); ++i) EXPECT_FALSE(parse_json(text.substr(0, i)));
  std::mt19937 random(7);
  for (int round = 0; round < 20000; ++round) {
    std::string damaged = text;
    for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = char(random() % 256);
    parse_json(damaged);
  }
}

TEST(Json, QuotedTextReadsBack) {
  for (const std::string& text :
       {std::string("plain"), std::string("a\"b\\c\n\t\x01/"), std::string("\xC3\xA9 \xF0\x9F\x98\x80"),
        std::string("nul\0byte", 8), std::string("")}) {
    const auto value = parse_json(json_quote(text));
    ASSERT_TRUE(value) << json_quote(text);
    EXPECT_EQ(value->text, text);
  }
}

TEST(Json, BytesThatAreNoUtf8BecomeTheReplacementCharacter) {
  for (const char* text : {"\xFF", "\xC3", "\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80"}) {
    const auto value = parse_json(json_quote(std::string("a") + text + "b"));
    ASSERT_TRUE(value);
    EXPECT_EQ(value->text.substr(0, 4), "a\xEF\xBF\xBD");
    EXPECT_EQ(value->text.back(), 'b');
  }
}

TEST(Json, NumbersReadBackExactly) {
  for (const double number : {0.0, -0.1, 1e300, 5e-324, 123456789.0, 1.0 / 3})
    EXPECT_EQ(parse_json(json_number(number))->number, number);
  EXPECT_EQ(json_number(std::numeric_limits<double>::quiet_NaN()), "null");
  EXPECT_EQ(json_number(-std::numeric_limits<double>::infinity()), "null");
}

TEST(Json, HoldsNoMoreValuesThanMemoryCanBear) {
  std::string text = "[0";
  for (int i = 1; i < 1 << 22; ++i) text += ",0";
  EXPECT_FALSE(parse_json(text + "]"));  // the array itself is one too many
  text.resize(2 * 100000);
  EXPECT_TRUE(parse_json(text + "]"));
}

}  // namespace
}  // namespace varve
