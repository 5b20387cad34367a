// The one refusal that the pixels can answer.
#pragma once

#include "base/error.h"

namespace varve {

/// Vectors are there, but neither names nor attributes tell what they mean.
struct UnknownConvention : Failure {
  explicit UnknownConvention(const std::string& sentence) : Failure(ExitCode::inconsistent, sentence) {}
};

}  // namespace varve
