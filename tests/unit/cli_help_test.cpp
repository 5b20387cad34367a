// Help and manuals come from the tables; the committed manuals are what the program prints.
#include "help.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "diagnose/aov.h"
#include "paths.h"
#include "plan/preset.h"
#include "progress.h"
#include "report_fields.h"

namespace varve::cli {
namespace {

std::string committed(const std::string& page) {
  std::ifstream in(std::string(VARVE_SOURCE) + "/man/" + page, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Manual, CommittedPagesAreWhatTheProgramPrints) {
  EXPECT_EQ(committed("varve.1"), manual_page(nullptr)) << "run scripts/renew_man";
  for (const Command& command : command_table())
    if (command.has_manual) {
      EXPECT_EQ(committed("varve-" + std::string(command.name) + ".1"), manual_page(&command))
          << "run scripts/renew_man";
    }
}

TEST(Manual, HasItsSectionsInOrder) {
  const std::vector<Command> commands = command_table();
  const std::string page = manual_page(find_command(commands, "resolve"));
  std::size_t at = 0;
  for (const char* heading : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "DIAGNOSTIC PLANES", "REJECTION BITS",
                              "CONVENTIONS", "PRESETS", "EXIT STATUS", "FILES", "ATTRIBUTES", "EXAMPLES", "SEE ALSO"}) {
    const std::size_t found = page.find(std::string("\n.SH ") + heading + "\n");
    ASSERT_NE(found, std::string::npos) << heading;
    EXPECT_GT(found, at) << heading;
    at = found;
  }
}

TEST(Help, AllShowsEveryOptionAndBasicSaysThatThereAreMore) {
  for (const Command& command : command_table()) {
    const std::vector<Option> options = options_of(command.bit);
    const std::string all = command_text(command, options, true), basic = command_text(command, options, false);
    bool rare = false;
    for (const Option& option : options) {
      EXPECT_NE(all.find("  " + option_title(option) + "\n"), std::string::npos) << option.name;
      EXPECT_EQ(basic.find("  " + option_title(option) + "\n") != std::string::npos, option.tier == Tier::basic);
      rare = rare || option.tier != Tier::basic;
    }
    EXPECT_EQ(basic.find("--help=all") != std::string::npos, rare) << command.name;
  }
}

TEST(Help, FitsIntoEightyColumns) {
  std::string text = overview_text() + usage_text();
  for (const Command& command : command_table()) text += command_text(command, options_of(command.bit), true);
  for (const Topic& topic : topics()) text += topic_text(topic);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 80u) << line;
    EXPECT_FALSE(line.ends_with(' ')) << line;
  }
}

TEST(Help, DefaultsAreThoseOfTheSettings) {
  for (const Option& option : option_table())
    if (option.name == "alpha") {
      EXPECT_NE(option_remarks(option).find("Default: 0.1."), std::string::npos);
    }
}

TEST(Topics, ShowTheTablesWhole) {
  std::string text;
  for (const Topic& topic : topics()) text += topic_text(topic);
  for (const Aov& aov : diagnostic_aovs()) EXPECT_NE(text.find("  " + std::string(aov.name)), std::string::npos);
  for (const Preset& preset : presets()) EXPECT_NE(text.find("  " + std::string(preset.name)), std::string::npos);
  for (const MotionConvention& row : motion_conventions())
    EXPECT_NE(text.find("  " + std::string(row.name)), std::string::npos);
}

TEST(Completion, NamesEveryOption) {
  const std::string script = bash_completion();
  for (const Option& option : option_table()) EXPECT_NE(script.find(dashed(option)), std::string::npos) << option.name;
}

TEST(ProgressLine, TellsWhatAQueueParses) {
  FrameReport report;
  report.frame = -7;
  report.written = true;
  report.read_seconds = 0.0312;
  EXPECT_EQ(frame_line(report, 43, 100), "frame -7: 0.031 s read, 0.000 s resolve, 0.000 s write, PROGRESS: 43%");
  report.skipped = true;
  EXPECT_EQ(frame_line(report, 1, 1), "frame -7: complete already, skipped, PROGRESS: 100%");
  report.skipped = report.written = false;
  EXPECT_NE(frame_line(report, 0, 8).find("for the history only, PROGRESS: 0%"), std::string::npos);
}

TEST(ProgressLine, NeverSaysTheWordThatQueuesLookFor) {
  FrameReport report;
  report.not_finite = report.vectors_bad = report.half_overflows = 3;
  report.restart = "cut";
  for (const std::string& line : {frame_line(report, 1, 2), object_text(frame_fields(), report)})
    EXPECT_EQ(line.find("rror"), std::string::npos) << line;
}

TEST(ClockText, CarriesMinutesAndHours) {
  EXPECT_EQ(clock_text(7), "0:07");
  EXPECT_EQ(clock_text(59.6), "1:00");
  EXPECT_EQ(clock_text(3723), "1:02:03");
  EXPECT_EQ(clock_text(-1), "0:00");
}

}  // namespace
}  // namespace varve::cli
