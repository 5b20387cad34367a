// Where code of others works on bytes that nobody vouches for.
#pragma once

#include <string>

namespace varve {

/// While it lives, a library decodes something: should it bring the program down, `sentence` is what is to be said.
/// Nested ones hide the outer. One at a time in the whole process.
class InForeignCode {
 public:
  explicit InForeignCode(std::string sentence);
  ~InForeignCode();
  InForeignCode(const InForeignCode&) = delete;
  InForeignCode& operator=(const InForeignCode&) = delete;

 private:
  std::string sentence_;
  const char* outer_;
};

/// The sentence in force, or null. May be called by a signal handler.
const char* foreign_sentence();

}  // namespace varve
