// Completion script for bash, from the tables.
#include "help.h"

namespace varve::cli {
namespace {

std::string words_of(std::span<const Option> options) {
  std::string words = "--help";
  for (const Option& option : options) words += " " + dashed(option);
  return words;
}

/// The arm that completes the value of an option.
std::string value_arm(const Option& option) {
  if (option.metavar.empty()) return "";
  std::string action = "return";
  if (!option.value.choices.empty()) {
    std::string words;
    for (const Choice& choice : option.value.choices) words += (words.empty() ? "" : " ") + choice.word;
    action = "mapfile -t COMPREPLY < <(compgen -W \"" + words + "\" -- \"$cur\"); return";
  } else if (option.completes == Completes::files) {
    action = "mapfile -t COMPREPLY < <(compgen -f -- \"$cur\"); return";
  } else if (option.completes == Completes::folders) {
    action = "mapfile -t COMPREPLY < <(compgen -d -- \"$cur\"); return";
  }
  const std::string letter = option.letter ? std::string("|-") + option.letter : "";
  return "        " + dashed(option) + letter + ") " + action + " ;;\n";
}

}  // namespace

std::string bash_completion() {
  std::string names, arms;
  const std::vector<Command> commands = command_table();
  for (const Command& command : commands) names += (names.empty() ? "" : " ") + std::string(command.name);
  std::string help_words = names;
  for (const Topic& topic : topics()) help_words += " " + topic.name;
  for (const Command& command : commands) {
    const std::vector<Option> options = options_of(command.bit);
    std::string values;
    for (const Option& option : options) values += value_arm(option);
    arms += "    " + std::string(command.name) + ")\n";
    if (!values.empty()) arms += "      case \"$prev\" in\n" + values + "      esac\n";
    arms += "      if [[ \"$cur\" == -* ]]; then mapfile -t COMPREPLY < <(compgen -W \"" + words_of(options) +
            "\" -- \"$cur\")\n";
    if (command.bit == kHelp)
      arms += "      else mapfile -t COMPREPLY < <(compgen -W \"" + help_words + "\" -- \"$cur\")\n";
    else if (!command.read_positional.choices.empty()) {
      std::string words;
      for (const Choice& choice : command.read_positional.choices) words += (words.empty() ? "" : " ") + choice.word;
      arms += "      else mapfile -t COMPREPLY < <(compgen -W \"" + words + "\" -- \"$cur\")\n";
    } else if (!command.positional.empty())
      arms += "      else mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n";
    arms += "      fi ;;\n";
  }
  return "# bash completion for varve\n"
         "_varve() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  # Bash splits --name=value at the sign.\n"
         "  if [[ \"$prev\" == = ]]; then prev=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
         "  if [[ \"$cur\" == = ]]; then cur=; fi\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then mapfile -t COMPREPLY < <(compgen -W \"" +
         names +
         " --help --version\" -- \"$cur\"); return; fi\n"
         "  case \"${COMP_WORDS[1]}\" in\n" +
         arms +
         "  esac\n"
         "}\n"
         "complete -o filenames -F _varve varve\n";
}

}  // namespace varve::cli
