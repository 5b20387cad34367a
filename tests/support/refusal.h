// What a refused call says.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/error.h"

namespace varve::test {

/// The sentence of the Failure that `call` must end with; a test failure if it ends otherwise or with another code.
inline std::string message_of(const std::function<void()>& call, ExitCode expected = ExitCode::inconsistent) {
  try {
    call();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), expected) << failure.what();
    return failure.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

}  // namespace varve::test
