// Prints the table of measured differences, the soaks and the counts of extremes: sequences/stability.md.
// Usage: varve_measure_stability [short] [laws | twins | soaks]
#include <cstdio>
#include <cstring>

#include "stability/laws.h"
#include "stability/soak.h"
#include "stability/twins.h"

namespace varve::stability {
namespace {

int broken = 0;

void print_twins(bool thorough, Workers& workers) {
  std::printf(
      "\n## Against the slow twins in double\n\n"
      "Worst difference of any value, over the largest value around it (the picture and its history within the reach "
      "of\n"
      "the pass). A step of float is 6e-8 of a value. Rows that are open have no bound: is_open() in "
      "tests/stability/twins.cpp says\nwhy. Colors beyond 1e37 are finite everywhere (above) and not compared.\n\n"
      "| pass | inputs | runs | values | worst | bound | found with |\n| --- | --- | ---: | ---: | ---: | ---: | --- "
      "|\n");
  for (const Measured& row : measure_twins(thorough, workers)) {
    broken += !(row.worst <= row.bound);
    std::printf("| %s | %s | %ld | %ld | %.1e | %.0e | %s |\n", row.pass.c_str(), row.inputs.c_str(), row.runs,
                row.values, row.worst, row.bound, row.where.c_str());
  }
}

void print_soaks(bool thorough, Workers& workers) {
  const int frames = thorough ? 10000 : 300;
  std::printf(
      "\n## Soaks\n\nRecursion of 9x7 pixels beside a twin whose history is kept in double: largest relative "
      "difference of any frame, and of\nthe last tenth of them.\n\n"
      "| what | frames | worst | at the end | bound |\n| --- | ---: | ---: | ---: | ---: |\n");
  const auto print = [](const Soaked& s) {
    broken += !(s.worst <= s.bound);
    std::printf("| %s | %d | %.1e | %.1e | %.0e |\n", s.name.c_str(), s.frames, s.worst, s.at_end, s.bound);
    std::fflush(stdout);
  };
  for (const SoakCase& c : soak_cases())
    for (const Sway sway : {Sway::rest, Sway::sway, Sway::pan}) print(soak(c.name, c.settings, sway, frames, workers));
  print(soak_mean(thorough ? 1000000 : 10000, workers));
  print(soak_small_alpha(thorough ? 1000000 : 10000, workers));
}

struct Law {
  const char* name;
  LawCounts counts;
  long held = 0, broken = 0;
  void take(const std::string& said, const std::string& what) {
    ++(said.empty() ? held : broken);
    if (!said.empty()) std::fprintf(stderr, "%s: %s: %s\n", name, what.c_str(), said.c_str());
  }
};

void print_laws(bool thorough, Workers& workers) {
  Law finite{"finite, every extreme", {}}, sizes{"finite, every size up to 16384 x 3", {}},
      halves{"finite, all 65536 half values", {}}, footprint{"a bad pixel reaches no farther than the pass reads", {}},
      scale{"light times 2^k is the result times 2^k, bit for bit", {}}, mirror{"a mirror changes only the sides", {}},
      constancy{"one color stays that color, bit for bit", {}}, threads{"1, 2 and 5 threads, bit for bit", {}};
  const std::vector<Pass> passes = thorough ? all_passes() : few_passes();
  const RawShot bits = all_halves();
  for (const Pass& pass : passes) {
    for (const Extreme& extreme : extremes())
      finite.take(broken_finite(pass, extreme.make({-5, -9, 14, 4}), workers, finite.counts),
                  pass.name + ", " + extreme.name);
    for (const Window& window : awkward_windows(true))
      sizes.take(broken_finite(pass, base_shot(window, Moves::any, 2, 30, true), workers, sizes.counts), pass.name);
    halves.take(broken_finite(pass, bits, workers, halves.counts), pass.name);
    for (const bool moves : {false, true})
      footprint.take(broken_footprint(pass, moves, workers, footprint.counts), pass.name);
    for (const int exponent : {1, 20, -20})
      if (pass.scales) scale.take(broken_scale(pass, exponent, workers, scale.counts), pass.name);
    for (const bool vertical : {false, true})
      if (pass.mirror >= 0) mirror.take(broken_mirror(pass, vertical, workers, mirror.counts), pass.name);
    for (const float value : {1.0f, 0.1f, 65504.0f, 1000.1f, 1e-30f, 3e-39f, -0.7f, 1e30f, 0.0f})
      if (pass.constant)
        constancy.take(broken_constancy(pass, {value, value * 0.3f, value * 0.77f, 1}, workers, constancy.counts),
                       pass.name);
    threads.take(broken_threads(pass, threads.counts), pass.name);
  }
  std::printf(
      "\n## Laws\n\n%zu passes of the tables in tests/stability, %zu kinds of hostile input.\n\n"
      "| law | asked | broken | runs of a pass | pixels |\n| --- | ---: | ---: | ---: | ---: |\n",
      passes.size(), extremes().size());
  for (const Law* law : {&finite, &sizes, &halves, &footprint, &scale, &mirror, &constancy, &threads}) {
    broken += int(law->broken);
    std::printf("| %s | %ld | %ld | %ld | %ld |\n", law->name, law->held + law->broken, law->broken, law->counts.runs,
                law->counts.pixels);
  }
}

}  // namespace
}  // namespace varve::stability

int main(int argc, char** argv) {
  using namespace varve::stability;
  bool thorough = true;
  const char* only = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "short") == 0)
      thorough = false;
    else
      only = argv[i];
  }
  const auto wanted = [&](const char* part) { return !only || std::strcmp(only, part) == 0; };
  varve::Workers workers(2);
  std::printf(
      "# Numerical stability, measured\n\nRenewed by scripts/measure_stability; nothing here is edited by hand. The "
      "short form of the same questions is the\nlabel `stability` of ctest, and asks besides, from files to files, "
      "every preset and every accumulator.\n");
  if (wanted("laws")) print_laws(thorough, workers);
  if (wanted("twins")) print_twins(thorough, workers);
  if (wanted("soaks")) print_soaks(thorough, workers);
  return broken > 0;
}
