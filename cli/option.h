// Table-driven parser: one row per option feeds parsing, range checks, --help, the manual and shell completion.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plan/knob.h"
#include "settings.h"

namespace varve::cli {

/// Commands as bits, so that an option can belong to several.
enum CommandBit : unsigned {
  kResolve = 1,
  kProbe = 2,
  kHelp = 4,
  kVersion = 8,
  kCompare = 16,
  kSynth = 32,
  kMeasure = 64,
  kFloor = 128,
  kJitter = 256
};

/// What completion offers for a value that is not one of a few words.
enum class Completes { nothing, files, folders };

struct Option {
  std::string name;     ///< without the dashes
  char letter = 0;      ///< short form, 0: none
  std::string metavar;  ///< empty: a flag
  unsigned commands = 0;
  Tier tier = Tier::basic;
  std::string group;
  std::string help;
  Value<Settings> value;  ///< a flag is read with an empty text
  bool repeats = false;   ///< may be given more than once; otherwise the later one wins
  bool first = false;     ///< applied before the others, wherever it stands (--preset)
  Completes completes = Completes::nothing;
  std::string topic = {};  ///< of `varve help` that explains the words; empty: the option does
};

/// THE table: every option of every command, in the order of help.
std::vector<Option> option_table();

/// Rows of one command.
std::vector<Option> options_of(unsigned command);

struct Example {
  std::string_view line, meaning;
};

struct Command {
  std::string_view name;
  unsigned bit;
  std::string_view positional;  ///< its positional argument; in brackets: may be left out; empty: none; "A B": two
  std::string_view summary;     ///< one line, no full stop
  std::string description;      ///< paragraphs with line feeds between
  Value<Settings> read_positional;
  int (*run)(Settings&);  ///< exit code
  bool has_manual = false;
  std::vector<Example> examples = {};
  Value<Settings> read_second = {};  ///< the second positional argument, if there are two
};

/// In the order of help.
std::vector<Command> command_table();
const Command* find_command(std::span<const Command> table, std::string_view name);

/// What a command line asks for.
struct Parsed {
  Settings settings;
  bool help = false, help_all = false;
};

/// Parses what follows the name of the command. Accepts `--name=value`, `--name value`, `-n value`, `--` before
/// positionals. Throws Failure(usage) with one sentence naming the option, the value and what is allowed.
Parsed parse(const Command& command, std::span<const Option> options, std::span<const std::string> arguments);

/// The word among `known` that is most like `word`, or "" when none is close.
std::string nearest_word(std::string_view word, std::span<const std::string> known);

/// "--alpha" as in messages and manuals; the default of an option as text, "" when there is none.
std::string dashed(const Option& option);
std::string default_of(const Option& option);

}  // namespace varve::cli
