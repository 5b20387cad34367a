// What is fuzzed: every reader of bytes that somebody else wrote.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace varve::fuzz {

using Random = std::mt19937_64;

/// One reader. `run` takes any bytes and returns 0; what is refused is refused by a Failure with a plain sentence, and
/// anything else ends the program. `mutate` changes one of the seeds, or what came of it.
struct Target {
  std::string_view name;
  int (*run)(const std::uint8_t*, std::size_t);
  std::vector<std::string> (*seeds)();
  std::string (*mutate)(const std::string& bytes, Random& random);
};

int fuzz_exr(const std::uint8_t*, std::size_t);         ///< flat files: probe, read, resolve, write
int fuzz_deep(const std::uint8_t*, std::size_t);        ///< the same of deep files
int fuzz_attributes(const std::uint8_t*, std::size_t);  ///< attributes as numbers, cameras, jitter, samples
int fuzz_json(const std::uint8_t*, std::size_t);
int fuzz_jitter(const std::uint8_t*, std::size_t);   ///< CSV of jitter
int fuzz_camera(const std::uint8_t*, std::size_t);   ///< CSV and JSON of cameras, and what is made of them
int fuzz_options(const std::uint8_t*, std::size_t);  ///< command lines, sequences, frame lists, presets

std::span<const Target> targets();
/// Null if there is none of that name.
const Target* find_target(std::string_view name);

std::vector<std::string> exr_seeds();
std::vector<std::string> deep_seeds();
std::vector<std::string> attribute_seeds();
std::vector<std::string> json_seeds();
std::vector<std::string> jitter_seeds();
std::vector<std::string> camera_seeds();
std::vector<std::string> option_seeds();

/// One file of each way to be read, for the tests of the program.
struct NamedSeed {
  std::string name, bytes;
};
std::vector<NamedSeed> named_seeds();

/// Damage that knows the layout of EXR files: fields, tables, chunks. Offsets are put right half of the time, so that
/// the damage reaches what lies behind them.
std::string mutate_exr(const std::string& bytes, Random& random);
/// Damage to text: bytes, numbers, pieces repeated, moved and left out.
std::string mutate_text(const std::string& bytes, Random& random);

/// Outcomes since the start, so that a run can tell whether it got past the first check.
struct Tally {
  std::uint64_t taken = 0, refused = 0;
};
Tally& tally();

/// Runs `read`, which may refuse its input by a Failure of exit code 2, 3 or 4 with a sentence; anything else ends the
/// program.
template <class Read>
bool taken_or_refused(Read read);
void check_refusal(int code, const char* sentence);

}  // namespace varve::fuzz

#include "base/error.h"

template <class Read>
bool varve::fuzz::taken_or_refused(Read read) {
  try {
    read();
    ++tally().taken;
    return true;
  } catch (const Failure& failure) {
    check_refusal(int(failure.code()), failure.what());
    ++tally().refused;
    return false;
  }
}
