// Command lines that end before any file is looked at.
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "program.h"
#include "sentence.h"

namespace varve::test {
namespace {

using Arguments = std::vector<std::string>;

TEST(Usage, NothingIsWrongUsage) {
  const Outcome outcome = run_varve({});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("Usage: varve COMMAND"), std::string::npos);
}

TEST(Usage, HelpGoesToStandardOutput) {
  for (const Arguments& arguments : {Arguments{"--help"},
                                     {"-h"},
                                     {"help"},
                                     {"help", "resolve"},
                                     {"help", "resolve", "--all"},
                                     {"resolve", "--help"},
                                     {"resolve", "-h"},
                                     {"resolve", "--help=all"},
                                     {"probe", "--help"},
                                     {"synth", "--help=all"},
                                     {"help", "scenes"},
                                     {"help", "presets"},
                                     {"help", "aovs"},
                                     {"help", "rejection"},
                                     {"help", "conventions"},
                                     {"help", "exit-codes"},
                                     {"help", "--man"},
                                     {"help", "--man", "resolve"},
                                     {"help", "--man", "probe"},
                                     {"help", "--man", "synth"},
                                     {"help", "--completion", "bash"},
                                     {"help", "help"}}) {
    const Outcome outcome = run_varve(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments.back();
    EXPECT_GT(outcome.out.size(), 50u) << arguments.back();
    EXPECT_TRUE(outcome.out.ends_with('\n')) << arguments.back();
    EXPECT_EQ(outcome.err, "") << arguments.back();
  }
}

TEST(Usage, Version) {
  for (const Arguments& arguments : {Arguments{"--version"}, {"version"}}) {
    const Outcome outcome = run_varve(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(outcome.out.starts_with("varve ") && outcome.out.ends_with('\n')) << outcome.out;
    EXPECT_EQ(outcome.err, "");
  }
}

struct Wrong {
  Arguments arguments;
  std::string culprit;
};

TEST(Usage, OneThingWrong) {
  const std::vector<Wrong> lines = {
      {{"reslve"}, "resolve"},
      {{"--alpha"}, "--alpha"},
      {{"help", "nothing"}, "nothing"},
      {{"help", "--man", "help"}, "help"},
      {{"help", "preset"}, "presets"},
      {{"help", "--completion", "zsh"}, "zsh"},
      {{"resolve"}, "IN"},
      {{"resolve", "in.####.exr"}, "--output"},
      {{"resolve", "in.####.exr", "-o"}, "--output"},
      {{"resolve", "", "-o", "out.####.exr"}, "IN"},
      {{"resolve", "in.0001.exr", "in.0002.exr", "-o", "out.####.exr"}, "in.0002.exr"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--unknown"}, "--unknown"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--alpha=0.1x"}, "0.1x"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--alpha=nan"}, "above 0 up to 1"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--gamma", "inf"}, "from 0 to 100"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--window", "4"}, "an odd whole number from 3 to 63"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--box", "sphere"}, "ellipsoid"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--hull-passes", "0"}, "from 1 to 64"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--frames="}, "--frames"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--frames", "10-"}, "10-"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--preset", "salvo"}, "salvo"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--convention", "martian"}, "martian"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--aov", "count,beauty"}, "beauty"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--resume=yes"}, "--resume"},
      {{"resolve", "in.####.exr", "-o", "out.####.exr", "--threads", "-1"}, "--threads"},
      {{"probe"}, "IN"},
      {{"probe", "in.####.exr", "--alpha", "0.1"}, "--alpha"},
      {{"probe", "in.####.exr", "--pixels", "1.5"}, "--pixels"},
      {{"version", "now"}, "now"},
  };
  for (const Wrong& line : lines) expect_refused(run_varve(line.arguments), 2, line.culprit);
}

/// Options that take a value, as the program itself lists them.
TEST(Usage, EachOptionWithoutItsValue) {
  for (const std::string command : {"resolve", "probe", "synth"}) {
    std::istringstream help(run_varve({command, "--help=all"}).out);
    int options = 0;
    for (std::string line; std::getline(help, line);) {
      const std::size_t dashes = line.find("--");
      if (!line.starts_with("  -") || line.find(' ', dashes) == std::string::npos) continue;
      const std::string name = line.substr(dashes, line.find(' ', dashes) - dashes);
      ++options;
      expect_refused(run_varve({command, "in.####.exr", name}), 2, name + " needs a value");
    }
    EXPECT_GT(options, 10) << command;
  }
}

/// What bash would offer for the last of these words.
std::string completed(const std::string& words) {
  Folder folder;
  std::ofstream(folder / "script") << "source <(" << VARVE_PROGRAM << " help --completion bash)\n"
                                   << "COMP_WORDS=(" << words << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_varve\n"
                                   << "echo ${COMPREPLY[@]} > " << (folder / "out").string() << "\n";
  EXPECT_EQ(std::system(("bash -u " + (folder / "script").string()).c_str()), 0);
  return bytes_of(folder / "out");
}

TEST(Usage, BashCompletes) {
  EXPECT_EQ(completed("varve res"), "resolve\n");
  EXPECT_EQ(completed("varve resolve in.exr --dil"), "--dilation\n");
  EXPECT_EQ(completed("varve resolve in.exr --dilation n"), "none nearest\n");
  EXPECT_EQ(completed("varve resolve in.exr --dilation = n"), "none nearest\n");
  EXPECT_EQ(completed("varve resolve in.exr --dilation ="), "none nearest longest\n");
  EXPECT_EQ(completed("varve probe --js"), "--json\n");
  EXPECT_EQ(completed("varve synth quality-a"), "quality-all\n");
  EXPECT_EQ(completed("varve help exit"), "exit-codes\n");
  EXPECT_EQ(completed("varve resolve --alpha 0"), "\n");
}

TEST(Usage, AFullDiskIsNoticed) {
  Folder folder;
  // What fits the buffer of the stream, and what does not.
  for (const std::string topic : {"probe", "resolve", "resolve --all"}) {
    const std::string line =
        std::string(VARVE_PROGRAM) + " help " + topic + " > /dev/full 2> " + (folder / "err").string();
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 5) << topic;
    EXPECT_NE(bytes_of(folder / "err").find("standard output"), std::string::npos) << topic;
  }
}

TEST(Usage, AReaderThatGoesAwayIsAQuietEnd) {
  Folder folder;
  const std::string line = "trap '' PIPE; { " + std::string(VARVE_PROGRAM) + " help resolve --all 2> " +
                           (folder / "err").string() + "; echo $? > " + (folder / "code").string() + "; } | :";
  std::ofstream(folder / "script") << line;
  ASSERT_EQ(std::system(("bash " + (folder / "script").string()).c_str()), 0);
  EXPECT_EQ(bytes_of(folder / "err"), "");
}

}  // namespace
}  // namespace varve::test
