// Vectors whose names tell nothing: the four samples of the courtyard, as another program would write them.
#include <gtest/gtest.h>

#include <filesystem>

#include "paths.h"
#include "program.h"

namespace varve::test {
namespace {

TEST(SettleMotion, PixelsAndNamesDecideTogether) {
  const std::string input = VARVE_DATA "/samples4/jit/frame.####.exr";
  if (!std::filesystem::exists(VARVE_DATA "/samples4")) GTEST_SKIP() << "no development data";
  const Folder folder;
  std::filesystem::create_directories(folder / "out");
  const Outcome dry = run_varve({"resolve", input, "-o", "out/o.####.exr", "--dry-run"}, folder.path());
  EXPECT_EQ(dry.code, 4) << "headers alone do not tell";
  const Outcome outcome =
      run_varve({"resolve", input, "-o", "out/o.####.exr", "-f", "5-6", "--progress", "none"}, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("to the previous frame, pixels, x right, y down, found from the pixels"),
            std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace varve::test
