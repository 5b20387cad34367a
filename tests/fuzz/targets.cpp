#include "fuzz/targets.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace varve::fuzz {

std::span<const Target> targets() {
  static const Target all[] = {
      {"exr", fuzz_exr, exr_seeds, mutate_exr},
      {"deep", fuzz_deep, deep_seeds, mutate_exr},
      {"attributes", fuzz_attributes, attribute_seeds, mutate_text},
      {"json", fuzz_json, json_seeds, mutate_text},
      {"jitter", fuzz_jitter, jitter_seeds, mutate_text},
      {"camera", fuzz_camera, camera_seeds, mutate_text},
      {"options", fuzz_options, option_seeds, mutate_text},
  };
  return all;
}

const Target* find_target(std::string_view name) {
  for (const Target& target : targets())
    if (target.name == name) return &target;
  return nullptr;
}

Tally& tally() {
  static Tally counts;
  return counts;
}

void check_refusal(int code, const char* sentence) {
  const std::size_t length = std::strlen(sentence);
  static const bool tell = std::getenv("VARVE_FUZZ_TELL") != nullptr;
  if (tell) std::fprintf(stderr, "%d %s\n", code, sentence);
  if (code >= 2 && code <= 4 && length > 10) return;
  std::fprintf(stderr, "a refusal with exit code %d: \"%s\"\n", code, sentence);
  std::abort();
}

}  // namespace varve::fuzz
