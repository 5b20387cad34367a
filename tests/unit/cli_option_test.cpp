// Laws of the parser, over every row of the option table.
#include "option.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "base/error.h"
#include "help.h"
#include "plan/preset.h"

namespace varve::cli {
namespace {

using Arguments = std::vector<std::string>;

Parsed parse_line(const char* command_name, const Arguments& arguments) {
  const std::vector<Command> commands = command_table();
  const Command* command = find_command(commands, command_name);
  const std::vector<Option> options = options_of(command->bit);
  return parse(*command, options, arguments);
}

Settings resolved(Arguments arguments) {
  arguments.insert(arguments.begin(), "in.####.exr");
  return parse_line("resolve", arguments).settings;
}

/// The sentence of a refused command line; "" when it is accepted.
std::string refusal(const std::string& command, const Arguments& arguments) {
  try {
    parse_line(command.c_str(), arguments);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::usage);
    return failure.what();
  }
  return "";
}

std::string refusal_of_option(Arguments arguments) {
  arguments.insert(arguments.begin(), "in.####.exr");
  return refusal("resolve", arguments);
}

bool takes_numbers(const Option& option) {
  return option.value.allowed.starts_with("a number") || option.value.allowed.starts_with("a whole number");
}

std::string command_of(const Option& option) {
  for (const Command& command : command_table())
    if (option.commands & command.bit) return std::string(command.name);
  return "help";
}

TEST(OptionTable, NamesAndLettersAreUniqueWithinACommand) {
  for (const Command& command : command_table()) {
    std::set<std::string> names = {"help"};
    std::set<char> letters = {'h'};
    for (const Option& option : options_of(command.bit)) {
      EXPECT_TRUE(names.insert(option.name).second) << command.name << " --" << option.name;
      if (option.letter) {
        EXPECT_TRUE(letters.insert(option.letter).second) << command.name << " -" << option.letter;
      }
    }
  }
}

TEST(OptionTable, EveryRowIsExplained) {
  for (const Option& option : option_table()) {
    EXPECT_NE(option.commands, 0u) << option.name;
    EXPECT_TRUE(option.help.ends_with('.')) << option.name;
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(option.help[0]))) << option.name;
    EXPECT_FALSE(option.group.empty()) << option.name;
    EXPECT_TRUE(option.value.read) << option.name;
    EXPECT_EQ(option.metavar.empty(), option.value.allowed.empty()) << option.name;
    for (const Choice& choice : option.value.choices)
      EXPECT_FALSE(choice.meaning.empty()) << option.name << choice.word;
  }
}

TEST(OptionTable, EveryShownDefaultIsAccepted) {
  for (const Option& option : option_table()) {
    const std::string standard = default_of(option);
    Settings settings;
    if (!standard.empty()) {
      EXPECT_TRUE(option.value.read(settings, standard)) << option.name << "=" << standard;
    }
  }
}

TEST(OptionTable, EveryWordIsAcceptedAndShownAgain) {
  for (const Option& option : option_table())
    for (const Choice& choice : option.value.choices) {
      Settings settings;
      ASSERT_TRUE(option.value.read(settings, choice.word)) << option.name << "=" << choice.word;
      if (option.value.show) {
        EXPECT_EQ(option.value.show(settings), choice.word) << option.name;
      }
    }
}

TEST(OptionTable, NumbersAreReadToTheirEnd) {
  int rows = 0;
  for (const Option& option : option_table()) {
    if (!takes_numbers(option)) continue;
    ++rows;
    for (const char* text : {"",     " ",    "1 ", " 1",  "1x", "0x1", "1,0",   "nan",    "inf",
                             "-inf", "-nan", "1e", "--1", "+",  "-",   "1e400", "-1e400", "99999999999999999999",
                             "1e10", "one"})
      EXPECT_NE(refusal(command_of(option), {"in", dashed(option) + "=" + text}), "") << option.name << "=" << text;
  }
  EXPECT_GT(rows, 8);
}

TEST(OptionTable, EveryOptionRefusesToStandWithoutItsValue) {
  for (const Option& option : option_table()) {
    if (option.metavar.empty()) continue;
    const std::string sentence = refusal(command_of(option), {"in", dashed(option)});
    EXPECT_TRUE(sentence.starts_with(dashed(option) + " needs a value: ")) << sentence;
    EXPECT_NE(refusal(command_of(option), {"in", dashed(option) + "="}), "") << option.name;
  }
}

TEST(OptionTable, FlagsTakeNoValue) {
  for (const Option& option : option_table())
    if (option.metavar.empty()) {
      EXPECT_NE(refusal(command_of(option), {"in", dashed(option) + "=1"}), "") << option.name;
    }
}

TEST(Parser, FormsOfAValueAreTheSame) {
  for (const Arguments& form : {Arguments{"--threads=3"}, {"--threads", "3"}, {"-j", "3"}})
    EXPECT_EQ(resolved(form).job.threads, 3) << form[0];
}

TEST(Parser, EndsOfRangesAreKept) {
  EXPECT_EQ(refusal_of_option({"--alpha", "1"}), "");
  EXPECT_NE(refusal_of_option({"--alpha", "1.0000001"}), "");
  EXPECT_NE(refusal_of_option({"--alpha", "0"}), "");
  EXPECT_EQ(refusal_of_option({"--alpha", "1e-6"}), "");
  EXPECT_EQ(refusal_of_option({"--gamma", "0"}), "");
  EXPECT_NE(refusal_of_option({"--gamma", "-0.1"}), "");
  EXPECT_EQ(refusal_of_option({"--zip-level", "9"}), "");
  EXPECT_NE(refusal_of_option({"--zip-level", "10"}), "");
  EXPECT_NE(refusal_of_option({"--zip-level", "2.5"}), "");
  EXPECT_EQ(refusal_of_option({"--alpha", "2"}), "--alpha takes a number above 0 up to 1, not \"2\"");
}

TEST(Parser, ValuesMayBeginWithADash) {
  EXPECT_EQ(resolved({"--frames", "-10--8"}).job.frames, (std::vector<int>{-10, -9, -8}));
  EXPECT_EQ(resolved({"--motion-bias", "-0.5"}).job.roles.encoding.bias, -0.5);
  EXPECT_EQ(resolved({"--motion-sign-y", "-1"}).job.roles.encoding.sign_y, -1.0);
}

TEST(Parser, AnOptionIsNoValueOfAnother) {
  EXPECT_TRUE(refusal_of_option({"--output", "--frames", "1"}).starts_with("--output needs a value"));
  EXPECT_TRUE(refusal_of_option({"-o", "-q"}).starts_with("--output needs a value"));
  EXPECT_TRUE(refusal_of_option({"-o", "--frames=1"}).starts_with("--output needs a value"));
  EXPECT_EQ(resolved({"--output=--frames"}).job.output.text(), "--frames");
}

TEST(Parser, LaterWinsAndListsGrow) {
  EXPECT_EQ(resolved({"--alpha", "0.5", "--alpha=0.25"}).job.parameters.recursive.alpha, 0.25);
  EXPECT_EQ(resolved({"-f", "1-3", "-f", "7"}).job.frames, std::vector<int>{7});
  EXPECT_EQ(resolved({"--layer", "a,b", "--layer", "c"}).job.roles.layers, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(resolved({"--map", "depth=a.Z", "--map", "R=x=y"}).job.roles.map.size(), 2u);
  EXPECT_EQ(resolved({"--map", "R=x=y"}).job.roles.map[0].second, "x=y");
  EXPECT_EQ(resolved({"--aov", "clip,count", "--aov", "clip"}).job.request.aovs,
            (std::vector<std::string>{"clip", "count"}));
}

TEST(Parser, PresetLiesBelowTheOptionsWhateverTheOrder) {
  for (const Arguments& line : {Arguments{"--alpha=0.5", "--preset=salvi"}, {"--preset=salvi", "--alpha=0.5"}})
    EXPECT_EQ(resolved(line).job.parameters.recursive.alpha, 0.5);
}

TEST(Parser, OverridesAreMarkedOnlyWhenGiven) {
  EXPECT_FALSE(resolved({}).job.roles.override_scale);
  const RoleRequest roles = resolved({"--motion-scale", "2", "--shutter=0.5", "--motion-unit", "ndc"}).job.roles;
  EXPECT_TRUE(roles.override_scale && roles.override_shutter && roles.override_unit);
  EXPECT_FALSE(roles.override_bias || roles.override_sign_x || roles.override_sign_y || roles.override_direction);
  EXPECT_EQ(roles.encoding.scale, 2);
  EXPECT_EQ(roles.encoding.unit, MotionUnit::ndc);
}

TEST(Parser, Compression) {
  EXPECT_EQ(resolved({}).job.compression, std::nullopt);
  EXPECT_EQ(resolved({"--compression", "zip"}).job.compression, Compression::zip);
  EXPECT_EQ(resolved({"--compression=zip", "--compression=keep"}).job.compression, std::nullopt);
}

TEST(Parser, PositionalsAreCounted) {
  EXPECT_TRUE(refusal("resolve", {}).starts_with("resolve needs IN"));
  EXPECT_NE(refusal("resolve", {"a.exr", "b.exr"}).find("\"b.exr\""), std::string::npos);
  EXPECT_NE(refusal("version", {"a"}), "");
  EXPECT_EQ(parse_line("resolve", {"--", "--odd.exr"}).settings.job.input.color.text(), "--odd.exr");
  EXPECT_NE(refusal("resolve", {"--odd.exr"}), "");
}

TEST(Parser, UnknownOptionsSuggestTheNearest) {
  EXPECT_NE(refusal_of_option({"--gama=1"}).find("did you mean --gamma?"), std::string::npos);
  EXPECT_NE(refusal_of_option({"--outptu", "x"}).find("did you mean --output?"), std::string::npos);
  EXPECT_NE(refusal_of_option({"--compress=zip"}).find("did you mean --compression?"), std::string::npos);
  EXPECT_EQ(refusal_of_option({"--qqqqqqqq"}).find("did you mean"), std::string::npos);
  EXPECT_NE(refusal_of_option({"-Q"}), "");
  EXPECT_NE(refusal("probe", {"in", "--alpha=0.5"}), "");
}

TEST(Parser, HelpIsAskedForAnywhereButBehindTwoDashes) {
  EXPECT_TRUE(parse_line("resolve", {"-h"}).help);
  EXPECT_TRUE(parse_line("resolve", {"in", "--alpha=0.1", "--help"}).help);
  EXPECT_TRUE(parse_line("resolve", {"--help=all"}).help_all);
  EXPECT_FALSE(parse_line("resolve", {"--", "--help"}).help);
  EXPECT_NE(refusal("resolve", {"--help=most"}), "");
}

TEST(Parser, EmptyAndStrangeListsAreRefused) {
  for (const char* list : {"", ",", "a,", ",a", "a,,b"})
    EXPECT_NE(refusal_of_option({std::string("--layer=") + list}), "") << list;
  for (const char* list : {"", "x", "1-", "1-5x0", "1 2", "1,,2"})
    EXPECT_NE(refusal_of_option({std::string("--frames=") + list}), "") << list;
  for (const char* map : {"", "R", "R=", "=x", "Q=x", "depth"})
    EXPECT_NE(refusal_of_option({std::string("--map=") + map}), "") << map;
  EXPECT_NE(refusal_of_option({"--aov=count,nothing"}), "");
}

TEST(NearestWord, FindsOneSlipAndNoMore) {
  const std::vector<std::string> words = {"alpha", "gamma", "window", "threads"};
  EXPECT_EQ(nearest_word("alhpa", words), "alpha");  // a swap
  EXPECT_EQ(nearest_word("gama", words), "gamma");
  EXPECT_EQ(nearest_word("thread", words), "threads");
  EXPECT_EQ(nearest_word("", words), "");
  EXPECT_EQ(nearest_word("xyzzy", words), "");
}

}  // namespace
}  // namespace varve::cli
