#include "base/foreign_code.h"

#include <atomic>
#include <utility>

namespace varve {
namespace {

// Global because a handler of signals has no other way to it.
std::atomic<const char*> in_force = nullptr;
static_assert(std::atomic<const char*>::is_always_lock_free);

}  // namespace

InForeignCode::InForeignCode(std::string sentence)
    : sentence_(std::move(sentence)), outer_(in_force.exchange(sentence_.c_str())) {}

InForeignCode::~InForeignCode() { in_force = outer_; }

const char* foreign_sentence() { return in_force; }

}  // namespace varve
