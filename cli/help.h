// Help as plain text, manual pages and shell completion, all from the tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "option.h"

namespace varve::cli {

/// Three lines for those who typed too little.
std::string usage_text();
/// The program and its commands.
std::string overview_text();
/// A command: its basic options, or all.
std::string command_text(const Command& command, std::span<const Option> options, bool all);

/// A table that `varve help NAME` prints and that is a section of the manuals.
struct Topic {
  std::string name;                                       ///< "exit-codes"
  std::string heading;                                    ///< "EXIT STATUS"
  std::string intro;                                      ///< a sentence or two
  std::vector<std::pair<std::string, std::string>> rows;  ///< term and what it means
};
std::vector<Topic> topics();
/// "presets, aovs, ...".
std::string topic_names();
std::string topic_text(const Topic& topic);

/// Options under their groups, groups and options in the order of the table.
std::vector<std::pair<std::string, std::vector<const Option*>>> grouped(std::span<const Option> options);
/// "-o, --output PATTERN".
std::string option_title(const Option& option);
/// What follows the help text: what the option takes, its default, whether it repeats.
std::string option_remarks(const Option& option);

/// roff of varve.1 (no command) or of varve-COMMAND.1.
std::string manual_page(const Command* command);
/// Completion script for bash.
std::string bash_completion();

}  // namespace varve::cli
