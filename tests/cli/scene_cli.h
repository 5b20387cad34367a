// What tests of the accumulators do from the command line: a scene of varve synth, resolved, held against its truth.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

#include "program.h"

namespace varve::test {

using Arguments = std::vector<std::string>;

class SceneCli : public testing::Test {
 protected:
  /// Renders into `in`.
  void synth(const std::string& scene, const std::string& frames, const Arguments& more = {}) const {
    Arguments line = {"synth", scene, "-o", "in", "--size", "64x36", "-f", frames, "-q"};
    line.insert(line.end(), more.begin(), more.end());
    ASSERT_EQ(run_varve(line, folder.path()).code, 0);
  }

  /// Resolves `input` into `to`/o.####.exr.
  Outcome resolve_into(const std::string& input, const std::string& to, const Arguments& choices,
                       const Arguments& more) const {
    std::filesystem::create_directories(folder / to);
    Arguments line = {"resolve", input, "-o", to + "/o.####.exr"};
    line.insert(line.end(), choices.begin(), choices.end());
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }

  static std::string number(int frame) { return (frame < 10 ? "000" : "00") + std::to_string(frame); }
  std::string path(const std::string& to, int frame) const { return folder / (to + "/o." + number(frame) + ".exr"); }

  /// PSNR against the box-filtered truth, over all frames given.
  double psnr(const std::string& scene, const std::string& to, const std::string& frames) const {
    const std::string out = run_varve({"compare", "in/truth/" + scene + ".####.exr", to + "/o.####.exr", "-f", frames,
                                       "--metrics", "psnr", "--json", "-"},
                                      folder.path())
                                .out;
    const std::size_t at = out.find("\"psnr\":");
    return at == std::string::npos ? 0 : std::strtod(out.c_str() + at + 7, nullptr);
  }

  Folder folder;
  const Arguments backward_only = {"--convention",        "varve", "--map",
                                   "motion.x=velocity.x", "--map", "motion.y=velocity.y"};
};

}  // namespace varve::test
