// varve jitter as a user meets it, and its list as varve resolve meets it.
#include <gtest/gtest.h>

#include "program.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

TEST(Jitter, ListsAreReadBackByResolveAsThePatternItself) {
  Folder folder;
  ASSERT_EQ(run_varve({"synth", "fence", "-o", "in", "-f", "1-5", "--size", "48x32", "-q"}, folder.path()).code, 0);
  ASSERT_EQ(run_varve({"jitter", "halton23:16", "--count", "5", "-o", "list.csv"}, folder.path()).code, 0);
  for (const std::string source : {"list.csv", "halton23:16"}) {
    const std::string out = source == "list.csv" ? "a" : "b";
    const Outcome outcome = run_varve({"resolve", "in/fence.####.exr", "-o", out + ".####.exr", "--jitter", source,
                                       "--sample-filter", "gaussian", "--keep", "none", "-q"},
                                      folder.path());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(bytes_of(folder / (out + ".0005.exr")), "");
  }
  // The headers name where the jitter came from; what was made of it is the same.
  EXPECT_EQ(run_varve({"compare", "a.####.exr", "b.####.exr"}, folder.path()).code, 0);
}

TEST(Jitter, TellsCentroidConventionAndTrap) {
  const Outcome csv = run_varve({"jitter", "halton23"});
  EXPECT_EQ(csv.code, 0);
  EXPECT_NE(csv.out.find("# centroid -0.029"), std::string::npos);
  EXPECT_NE(csv.out.find("\nframe,jx,jy\n1,0,-0.16"), std::string::npos);
  EXPECT_NE(run_varve({"jitter", "halton23", "--centered"}).out.find("subtracted"), std::string::npos);
  EXPECT_NE(run_varve({"help", "jitter-conventions"}).out.find("a quarter of"), std::string::npos);
  EXPECT_NE(run_varve({"help", "patterns"}).out.find("rotated4-helix"), std::string::npos);
  EXPECT_NE(run_varve({"jitter", "r2", "--format", "json", "--count", "2"}).out.find("\"jx\""), std::string::npos);
}

TEST(Jitter, WhatCannotBeIsRefused) {
  expect_refused(run_varve({"jitter"}), 2, "PATTERN");
  expect_refused(run_varve({"jitter", "sobol"}), 2, "sobol");
  expect_refused(run_varve({"jitter", "uniform4:5"}), 2, "4 points");
  expect_refused(run_varve({"jitter", "halton23", "--count", "0"}), 2, "--count");
  expect_refused(run_varve({"jitter", "halton23", "--convention", "cycles"}), 2, "--size");
  expect_refused(run_varve({"jitter", "halton23", "-o", "no/such/folder/x.csv"}), 5, "no/such/folder");
}

TEST(Filters, ThoseThatAmplifyAreRefusedAndTheOthersRun) {
  Folder folder;
  ASSERT_EQ(run_varve({"synth", "fence", "-o", "in", "-f", "1-3", "--size", "48x32", "-q"}, folder.path()).code, 0);
  const auto resolve = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"resolve", "in/fence.####.exr", "-o", "out.####.exr", "-q"});
    return run_varve(more, folder.path());
  };
  for (const char* name : {"lanczos3", "lanczos4"}) expect_refused(resolve({"--history-filter", name}), 2, "amplifies");
  expect_refused(resolve({"--history-filter", "cubic", "--cubic-c", "0.75"}), 2, "1.029");
  expect_refused(resolve({"--unjitter", "bilinear", "--jitter", "none"}), 4, "--unjitter none");
  expect_refused(resolve({"--unjitter", "bilinear", "--sample-filter", "tent"}), 2, "--sample-filter");
  for (const char* name : {"cubic", "bspline3", "bspline5"}) EXPECT_EQ(resolve({"--history-filter", name}).code, 0);
  EXPECT_EQ(resolve({"--unjitter", "bilinear"}).code, 0);
}

TEST(Presets, MeasureOfAllLeavesOutWhatTheSequenceCannotDo) {
  Folder folder;
  ASSERT_EQ(run_varve({"synth", "fence", "-o", "in", "-f", "1-3", "--size", "48x32", "-q"}, folder.path()).code, 0);
  const Outcome all = run_varve({"measure", "in/fence.####.exr", "--jitter", "none", "--repeats", "1"}, folder.path());
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_NE(all.err.find("warning: inside is left out"), std::string::npos) << all.err;
  EXPECT_NE(all.out.find("salvi"), std::string::npos);
  const Outcome named =
      run_varve({"measure", "in/fence.####.exr", "--jitter", "none", "--repeats", "1", "-p", "inside"}, folder.path());
  EXPECT_EQ(named.code, 4) << named.err;
}

TEST(Presets, AllRun) {
  Folder folder;
  ASSERT_EQ(run_varve({"synth", "fence", "-o", "in", "-f", "1-3", "--size", "48x32", "-q"}, folder.path()).code, 0);
  for (const std::string name : {"salvi", "lopez", "crytek2", "inside"})
    EXPECT_EQ(
        run_varve({"resolve", "in/fence.####.exr", "-o", name + ".####.exr", "-p", name, "-q"}, folder.path()).code, 0)
        << name;
}

TEST(Sharpen, IsNeverFedBack) {
  // The last frame resolved with sharpening is the sharpened form of the plain one: a second frame built on a sharpened
  // first one would differ from a run whose first frame was not written at all.
  Folder folder;
  ASSERT_EQ(run_varve({"synth", "fence", "-o", "in", "-f", "1-3", "--size", "48x32", "-q"}, folder.path()).code, 0);
  for (const std::string part : {"all", "last"}) {
    std::vector<std::string> line = {
        "resolve", "in/fence.####.exr", "-o", part + ".####.exr", "--sharpen", "0.8", "--keep", "none", "-q"};
    if (part == "last") line.insert(line.end(), {"--frames", "3", "--preroll", "2"});
    ASSERT_EQ(run_varve(line, folder.path()).code, 0);
  }
  EXPECT_EQ(run_varve({"compare", "all.####.exr", "last.####.exr", "-f", "3"}, folder.path()).code, 0);
  ASSERT_EQ(
      run_varve({"resolve", "in/fence.####.exr", "-o", "plain.####.exr", "--keep", "none", "-q"}, folder.path()).code,
      0);
  EXPECT_EQ(run_varve({"compare", "all.####.exr", "plain.####.exr"}, folder.path()).code, 1);
}

}  // namespace
}  // namespace varve::test
