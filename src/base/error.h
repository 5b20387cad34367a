// How things end: the documented exit codes, and the one exception that carries a plain sentence.
#pragma once

#include <stdexcept>
#include <string>

namespace varve {

/// Exit codes of the program (man page EXIT STATUS).
enum class ExitCode {
  done = 0,
  differences = 1,   ///< compare found differences
  usage = 2,         ///< unknown option, bad value
  input = 3,         ///< input missing or unreadable
  inconsistent = 4,  ///< inputs that do not fit together: channels, windows, vectors
  output = 5,        ///< output could not be written
  self_check = 6,    ///< a numeric self-check failed
  interrupted = 130,
  terminated = 143,
};

/// A failure to be shown to the user as it is: one sentence with file, layer, frame and remedy.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace varve
