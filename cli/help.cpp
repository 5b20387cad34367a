// Help as plain text, 80 columns.
#include "help.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"
#include "commands.h"
#include "report.h"

namespace varve::cli {
namespace {

constexpr std::size_t kColumns = 80;

/// Breaks text at blanks; every line starts with `indent` blanks.
std::string wrap(std::string_view text, std::size_t indent) {
  std::string out, line;
  const auto flush = [&] {
    if (!line.empty()) out += std::string(indent, ' ') + line + "\n";
    line.clear();
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    const std::string_view word = text.substr(0, end);
    if (!line.empty() && indent + line.size() + 1 + word.size() > kColumns) flush();
    if (!word.empty()) line += (line.empty() ? "" : " ") + std::string(word);
    if (end < text.size() && text[end] == '\n') {
      flush();
      out += "\n";
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  flush();
  return out;
}

/// Terms in a column, their meanings wrapped beside them.
std::string table(const std::vector<std::pair<std::string, std::string>>& rows, std::size_t indent) {
  std::size_t width = 0;
  for (const auto& [term, meaning] : rows) width = std::max(width, term.size());
  std::string out;
  for (const auto& [term, meaning] : rows) {
    std::string text = wrap(meaning, indent + width + 2);
    if (text.empty()) text = std::string(indent + width + 2, ' ') + "\n";
    text.replace(indent, term.size(), term);
    out += text;
  }
  return out;
}

std::string synopsis(const Command& command) {
  const bool has_options = !options_of(command.bit).empty();
  return "varve " + std::string(command.name) +
         (command.positional.empty() ? "" : " " + std::string(command.positional)) +
         (command.bit == kResolve ? " -o OUT"
          : command.bit == kSynth ? " -o DIR"
                                  : "") +
         (has_options ? " [OPTION]..." : "");
}

std::string commands_list() {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Command& command : command_table()) rows.emplace_back(command.name, command.summary);
  return table(rows, 2);
}

}  // namespace

std::string usage_text() {
  return "Usage: varve COMMAND [ARGUMENT]...\n" + commands_list() + "`varve help` explains more.\n";
}

std::string overview_text() {
  return "varve " + std::string(version()) + ", an offline temporal resolve of rendered OpenEXR sequences\n\n" +
         "Usage: varve COMMAND [ARGUMENT]...\n\nCommands:\n" + commands_list() + "\n" +
         wrap(
             "`varve help COMMAND` explains a command, `varve help COMMAND --all` with its rare options too. Further "
             "topics of "
             "`varve help`: " +
                 topic_names() + ".",
             0);
}

std::vector<std::pair<std::string, std::vector<const Option*>>> grouped(std::span<const Option> options) {
  std::vector<std::pair<std::string, std::vector<const Option*>>> groups;
  for (const Option& option : options) {
    auto group = std::ranges::find(groups, option.group, [](const auto& entry) { return entry.first; });
    if (group == groups.end()) group = groups.insert(group, {option.group, {}});
    group->second.push_back(&option);
  }
  return groups;
}

std::string option_title(const Option& option) {
  return (option.letter ? std::string("-") + option.letter + ", " : "") + dashed(option) +
         (option.metavar.empty() ? "" : " " + option.metavar);
}

std::string option_remarks(const Option& option) {
  std::string text;
  const auto say = [&text](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  if (!option.metavar.empty() && (option.value.choices.empty() || !option.topic.empty()))
    say("Takes " + option.value.allowed + ".");
  if (option.repeats) say("May be given more than once; all count.");
  if (const std::string standard = default_of(option); !standard.empty()) say("Default: " + standard + ".");
  return text;
}

std::string command_text(const Command& command, std::span<const Option> options, bool all) {
  std::string out = "Usage: " + synopsis(command) + "\n\n" + wrap(command.description, 0);
  std::size_t hidden = 0;
  for (const auto& [group, rows] : grouped(options)) {
    std::string text;
    for (const Option* option : rows) {
      if (!all && option->tier != Tier::basic) {
        ++hidden;
        continue;
      }
      text += "  " + option_title(*option) + "\n" + wrap(option->help + " " + option_remarks(*option), 6);
      if (option->topic.empty() && !option->value.choices.empty()) {
        std::vector<std::pair<std::string, std::string>> words;
        for (const Choice& choice : option->value.choices) words.emplace_back(choice.word, choice.meaning);
        text += table(words, 8);
      }
    }
    if (!text.empty()) out += "\n" + group + ":\n" + text;
  }
  if (hidden > 0)
    out += "\n" + std::to_string(hidden) + " more options: `varve " + std::string(command.name) + " --help=all`.\n";
  return out;
}

std::string topic_text(const Topic& topic) {
  return (topic.intro.empty() ? "" : wrap(topic.intro, 0) + "\n") + table(topic.rows, 2);
}

int run_help(Settings& settings) {
  const std::vector<Command> commands = command_table();
  const Command* command = find_command(commands, settings.topic);
  std::string text;
  if (!settings.completion.empty()) {
    text = bash_completion();
  } else if (settings.man) {
    const bool program = settings.topic.empty() || settings.topic == "varve";
    if (!program && !(command && command->has_manual))
      throw Failure(ExitCode::usage, "there is no manual page for \"" + settings.topic + "\"");
    text = manual_page(program ? nullptr : command);
  } else if (settings.topic == "report-schema") {
    text = report_schema();
  } else if (settings.topic.empty()) {
    text = overview_text();
  } else if (command) {
    text = command_text(*command, options_of(command->bit), settings.all);
  } else {
    const std::vector<Topic> all = topics();
    const auto topic = std::ranges::find(all, settings.topic, &Topic::name);
    if (topic == all.end()) {
      std::vector<std::string> names;
      for (const Command& known : commands) names.emplace_back(known.name);
      for (const Topic& known : all) names.push_back(known.name);
      const std::string nearest = nearest_word(settings.topic, names);
      throw Failure(ExitCode::usage,
                    "there is no help on \"" + settings.topic + "\"" +
                        (nearest.empty() ? "; the topics are " + topic_names() : "; did you mean " + nearest + "?"));
    }
    text = topic_text(*topic);
  }
  std::fputs(text.c_str(), stdout);
  return int(ExitCode::done);
}

}  // namespace varve::cli
