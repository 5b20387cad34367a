// What every refusal looks like.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "program.h"

namespace varve::test {

/// The exit code, nothing on standard output, and a last line "varve: error: SENTENCE" that names the culprit; warnings
/// may stand before it.
inline void expect_refused(const Outcome& outcome, int code, const std::string& culprit) {
  SCOPED_TRACE(outcome.err);
  EXPECT_EQ(outcome.code, code);
  EXPECT_EQ(outcome.out, "");
  ASSERT_TRUE(outcome.err.ends_with('\n'));
  const std::size_t at = outcome.err.find("varve: error: ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_TRUE(at == 0 || outcome.err[at - 1] == '\n');
  const std::string sentence = outcome.err.substr(at + 14);
  EXPECT_EQ(std::ranges::count(sentence, '\n'), 1) << "one line, and the last one";
  EXPECT_EQ(sentence.find("rror"), std::string::npos) << "the word stands once, in front";
  EXPECT_NE(sentence.find(culprit), std::string::npos) << culprit;
}

}  // namespace varve::test
