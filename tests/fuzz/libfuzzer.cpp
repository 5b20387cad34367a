// One target under libFuzzer. VARVE_FUZZ_TARGET names it.
#include <algorithm>
#include <cstring>

#include "fuzz/targets.h"

// The entry points that libFuzzer looks for.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

const varve::fuzz::Target& target() {
  static const varve::fuzz::Target* found = varve::fuzz::find_target(VARVE_FUZZ_TARGET);
  return *found;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { return target().run(data, size); }

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  // Its own mutations know what comparisons failed on; ours know where a file has its fields.
  if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  varve::fuzz::Random random(seed);
  const std::string damaged = target().mutate(std::string(reinterpret_cast<const char*>(data), size), random);
  const std::size_t kept = std::min(damaged.size(), most);
  std::memcpy(data, damaged.data(), kept);
  return kept;
}
