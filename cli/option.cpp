#include "option.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"

namespace varve::cli {
namespace {

[[noreturn]] void refuse(const std::string& sentence) { throw Failure(ExitCode::usage, sentence); }

std::string quoted(std::string_view text) { return '"' + std::string(text) + '"'; }

/// Number of single-letter changes between two words, a swap of neighbors counting as one.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j + 1] + 1, row[j] + 1, last[j] + (a[i] == b[j] ? 0u : 1u)});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

struct Given {
  const Option* option;
  std::string value;
};

/// Walks over the arguments once.
class Reader {
 public:
  Reader(const Command& command, std::span<const Option> options, std::span<const std::string> arguments)
      : command_(command), options_(options), arguments_(arguments) {}

  Parsed read();

 private:
  void read_long(const std::string& argument);
  void read_short(const std::string& argument);
  void take(const Option& option);
  void set(const Value<Settings>& value, const std::string& name, const std::string& text);
  void apply_positionals();
  const Option* find(std::string_view typed) const;

  const Command& command_;
  std::span<const Option> options_;
  std::span<const std::string> arguments_;
  std::size_t next_ = 0;
  std::vector<Given> given_;
  std::vector<std::string> positionals_;
  Parsed parsed_;
};

/// The option that "--name", "--name=value" or "-n" names.
const Option* Reader::find(std::string_view typed) const {
  for (const Option& option : options_) {
    if (typed.size() == 2 && typed[0] == '-' && option.letter != 0 && typed[1] == option.letter) return &option;
    if (typed.starts_with("--") && typed.substr(2, typed.find('=') - 2) == option.name) return &option;
  }
  return nullptr;
}

Parsed Reader::read() {
  bool only_positionals = false;
  while (next_ < arguments_.size() && !parsed_.help) {
    const std::string& argument = arguments_[next_++];
    if (only_positionals || argument.size() < 2 || argument[0] != '-') {
      positionals_.push_back(argument);
    } else if (argument == "--") {
      only_positionals = true;
    } else if (argument == "-h" || argument == "--help" || argument == "--help=all") {
      parsed_.help = true;
      parsed_.help_all = argument == "--help=all";
    } else if (argument.starts_with("--")) {
      read_long(argument);
    } else {
      read_short(argument);
    }
  }
  if (parsed_.help) return parsed_;
  // A preset lies under the options that were given by name, whatever the order on the line.
  std::stable_partition(given_.begin(), given_.end(), [](const Given& given) { return given.option->first; });
  for (const Given& given : given_) {
    set(given.option->value, dashed(*given.option), given.value);
    parsed_.settings.given.emplace_back(
        given.option->commands, dashed(*given.option) + (given.option->metavar.empty() ? "" : "=" + given.value));
  }
  apply_positionals();
  return parsed_;
}

void Reader::read_long(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  const std::string typed = argument.substr(0, equals);
  if (typed == "--help") refuse("--help takes nothing or \"all\", not " + quoted(argument.substr(equals + 1)));
  const Option* option = find(typed);
  if (!option) {
    std::vector<std::string> known;
    for (const Option& row : options_) known.push_back(row.name);
    const std::string nearest = nearest_word(typed.substr(2), known);
    refuse(std::string(command_.name) + " has no option " + typed +
           (nearest.empty() ? "; `varve help " + std::string(command_.name) + " --all` lists what there is"
                            : "; did you mean --" + nearest + "?"));
  }
  if (equals == std::string::npos) return take(*option);
  if (option->metavar.empty())
    refuse(typed + " takes no value, but " + quoted(argument.substr(equals + 1)) + " is given");
  given_.push_back({option, argument.substr(equals + 1)});
}

void Reader::read_short(const std::string& argument) {
  const Option* option = find(argument);
  if (!option)
    refuse(std::string(command_.name) + " has no option " + argument + "; `varve help " + std::string(command_.name) +
           " --all` lists what there is");
  take(*option);
}

/// Takes the value from the next argument. Negative numbers are values; another option of this command is not, because
/// then the value was forgotten (`--x=--y` still says it).
void Reader::take(const Option& option) {
  if (option.metavar.empty()) {
    given_.push_back({&option, ""});
    return;
  }
  const bool missing = next_ == arguments_.size() || arguments_[next_] == "--" || find(arguments_[next_]);
  if (missing) refuse(dashed(option) + " needs a value: " + option.value.allowed);
  given_.push_back({&option, arguments_[next_++]});
}

void Reader::set(const Value<Settings>& value, const std::string& name, const std::string& text) {
  bool accepted = false;
  try {
    accepted = value.read(parsed_.settings, text);
  } catch (const Failure& failure) {
    // Sentences of the library do not know which option brought the text.
    throw Failure(failure.code(), name + ": " + failure.what());
  }
  if (!accepted) refuse(name + " takes " + value.allowed + ", not " + quoted(text));
}

void Reader::apply_positionals() {
  const std::string name(command_.positional);
  const bool optional = name.starts_with('['), two = command_.read_second.read != nullptr;
  const std::size_t most = name.empty() ? 0 : two ? 2 : 1;
  if (positionals_.size() < most && !optional)
    refuse(std::string(command_.name) + " needs " + name + ": " +
           (positionals_.empty() ? command_.read_positional : command_.read_second).allowed);
  if (positionals_.size() > most)
    refuse(std::string(command_.name) + " takes " + (most == 0 ? "no argument" : (two ? "" : "one ") + name) +
           ", and " + quoted(positionals_[most]) + " is one too many" +
           (optional || most == 0 ? "" : "; a sequence is written as one pattern, such as shot.####.exr"));
  if (!positionals_.empty())
    set(command_.read_positional, two ? name.substr(0, name.find(' ')) : name, positionals_[0]);
  if (positionals_.size() > 1) set(command_.read_second, name.substr(name.find(' ') + 1), positionals_[1]);
}

}  // namespace

std::vector<Option> options_of(unsigned command) {
  std::vector<Option> rows = option_table();
  std::erase_if(rows, [command](const Option& option) { return (option.commands & command) == 0; });
  return rows;
}

const Command* find_command(std::span<const Command> table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &Command::name);
  return found == table.end() ? nullptr : &*found;
}

Parsed parse(const Command& command, std::span<const Option> options, std::span<const std::string> arguments) {
  return Reader(command, options, arguments).read();
}

std::string nearest_word(std::string_view word, std::span<const std::string> known) {
  std::string best;
  std::size_t least = 1 + word.size() / 3;  // one change in three letters still looks like the same word
  for (const std::string& candidate : known) {
    const std::size_t d = distance(word, candidate);
    const bool begins = word.size() >= 3 && candidate.starts_with(word);
    if (d <= least || (begins && best.empty())) {
      if (d <= least) least = d == 0 ? 0 : d - 1;
      best = candidate;
    }
  }
  return best;
}

std::string dashed(const Option& option) { return "--" + option.name; }

std::string default_of(const Option& option) {
  return option.metavar.empty() || !option.value.show ? "" : option.value.show(Settings{});
}

}  // namespace varve::cli
