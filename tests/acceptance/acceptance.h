// What the acceptance tests have in common: worlds written as files, the program run on them, its files read back.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/program.h"
#include "plan/preset.h"
#include "support/frame_file.h"

namespace varve::test {

using Arguments = std::vector<std::string>;

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The 20 tests at the end of the survey of real-time resolvers, each by its number, all end to end.
class Acceptance : public testing::Test {
 protected:
  /// Resolves in.####.exr of `from` into o.####.exr of `to`. The motion is right unless a test says otherwise, and
  /// worlds of a few pixels give the check of it little to see: it is left out.
  Outcome resolve(const std::string& from, const std::string& to, const Arguments& choices) const {
    std::filesystem::create_directories(folder / to);
    return run_varve(
        Arguments{"resolve", from + "/in.####.exr", "-o", to + "/o.####.exr", "--check-motion", "off"} + choices,
        folder.path());
  }
  /// The same, and it must go well.
  void resolve_well(const std::string& from, const std::string& to, const Arguments& choices) const {
    const Outcome outcome = resolve(from, to, choices);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  ReadFile read(const std::string& to, int frame) const {
    return read_frame_file(folder / (to + "/o." + frame_number(frame) + ".exr"));
  }
  std::string bytes(const std::string& to, int frame) const {
    return bytes_of(folder / (to + "/o." + frame_number(frame) + ".exr"));
  }
  void write(const std::string& name, const World& world, int first, int last, const FileOptions& options = {}) const {
    write_shot(folder / name, world, first, last, options);
  }

  Folder folder;
};

template <class F>
void each_pixel(const Window& w, const F& f) {
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) f(x, y);
}

/// The window without a rim.
inline Window inside_of(const Window& w, int rim) { return {w.x0 + rim, w.y0 + rim, w.x1 - rim, w.y1 - rim}; }

/// Every preset, as arguments.
inline std::vector<Arguments> all_presets() {
  std::vector<Arguments> all;
  for (const Preset& preset : presets()) all.push_back({"--preset", std::string(preset.name)});
  return all;
}

/// Whether what is known of frames after the present has a part in a preset's result.
inline bool looks_ahead(const Preset& preset) {
  const Accumulator accumulator = preset_parameters(preset).accumulator;
  return accumulator == Accumulator::gather || accumulator == Accumulator::two_sided;
}

}  // namespace varve::test
