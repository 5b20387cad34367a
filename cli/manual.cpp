// Manual pages as roff (man macros), checked with groff -ww.
#include <algorithm>
#include <cctype>

#include "help.h"

namespace varve::cli {
namespace {

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return text;
}

/// Text in which nothing is a command of roff. Every dash is one that can be typed.
std::string escaped(std::string_view text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\(rs";
    else if (c == '-')
      out += "\\-";
    else if (c == '`')
      out += "\\(ga";
    else
      out += c;
    line_start = c == '\n';
  }
  return out;
}

std::string section(std::string_view heading) { return ".SH " + upper(escaped(heading)) + "\n"; }

std::string paragraphs(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::string_view paragraph = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(paragraph.size() + 1, text.size()));
    out += (out.empty() ? "" : ".PP\n") + escaped(paragraph) + "\n";
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string item(const std::string& title, std::string_view text) {
  return ".TP\n" + title + "\n" + escaped(text) + "\n";
}

std::string option_item(const Option& option) {
  std::string title = bold(dashed(option));
  if (option.letter) title = bold(std::string("-") + option.letter) + ", " + title;
  if (!option.metavar.empty()) title += " " + italic(option.metavar);
  const std::string remarks = option_remarks(option);
  std::string out = item(title, option.help + (remarks.empty() ? "" : " " + remarks));
  if (!option.topic.empty() || option.value.choices.empty()) return out;
  out += ".RS\n";
  for (const Choice& choice : option.value.choices) out += item(bold(choice.word), choice.meaning);
  return out + ".RE\n";
}

std::string topic_section(const Topic& topic) {
  std::string out = section(topic.heading);
  if (!topic.intro.empty()) out += escaped(topic.intro) + "\n";
  for (const auto& [term, meaning] : topic.rows) out += item(bold(term), meaning);
  return out;
}

/// The topics whose section a page has.
std::string topic_sections(std::initializer_list<std::string_view> names) {
  std::string out;
  for (const std::string_view name : names)
    for (const Topic& topic : topics())
      if (topic.name == name) out += topic_section(topic);
  return out;
}

std::string title_line(const std::string& page, std::string_view summary) {
  return ".TH " + upper(escaped(page)) + " 1 \"\" \"varve " + version() + "\" \"User Commands\"\n" + section("Name") +
         escaped(page) + " \\- " + escaped(summary) + "\n";
}

std::string files_section() {
  return section("Files") +
         item(bold("OUT.NNNN.exr"),
              "Written under a temporary name in the same folder, flushed, and renamed, so that a file under its own "
              "name is "
              "complete. A symbolic link under that name is replaced, not followed.") +
         item(bold(".OUT.NNNN.exr.varve-*.tmp"),
              "Temporary files, locked while they are written. What a process left that was killed is removed by the "
              "next "
              "run that writes into the folder; those of live processes stay.") +
         section("Attributes") +
         "The first part of every output holds the version of varve, the parameters and the input frames that were "
         "used (varve:frames), with a print of what they held (varve:inputs), by which --resume notices frames that "
         "were "
         "rendered again, and no time of day: equal work gives equal bytes.\n";
}

std::string examples_section(std::span<const Example> examples) {
  std::string out = section("Examples");
  for (const Example& example : examples) out += item(bold(example.line), example.meaning);
  return out;
}

std::string see_also(std::string_view self) {
  std::vector<std::string> pages = {"varve"};
  for (const Command& command : command_table())
    if (command.has_manual) pages.push_back("varve-" + std::string(command.name));
  std::erase(pages, self);
  std::string out = section("See also");
  for (const std::string& page : pages)
    out += ".BR " + escaped(page) + " (1)" + (page == pages.back() ? "" : ",") + "\n";
  return out;
}

std::string program_page() {
  std::string out = title_line("varve", "offline temporal resolve of rendered OpenEXR sequences");
  out += section("Synopsis") + bold("varve") + " " + italic("COMMAND") + " [" + italic("ARGUMENT") + "]...\n";
  out +=
      section("Description") +
      escaped(
          "Varve turns a noisy, aliased sequence of rendered OpenEXR files into a steady one, and says what it did.") +
      "\n" + section("Commands");
  std::vector<Example> examples;
  for (const Command& command : command_table()) {
    out += item(bold(command.name), std::string(command.summary) + ".");
    examples.insert(examples.end(), command.examples.begin(), command.examples.begin() + !command.examples.empty());
  }
  return out + topic_sections({"exit-codes"}) + examples_section(examples) + see_also("varve");
}

std::string command_page(const Command& command) {
  const std::string page = "varve-" + std::string(command.name);
  const std::vector<Option> options = options_of(command.bit);
  std::string out = title_line(page, command.summary);
  out += section("Synopsis") + bold("varve " + std::string(command.name)) + " " + italic(command.positional) + " " +
         (command.bit == kResolve ? bold("-o") + " " + italic("OUT") + " "
          : command.bit == kSynth ? bold("-o") + " " + italic("DIR") + " "
                                  : "") +
         "[" + italic("OPTION") + "]...\n";
  out += section("Description") + paragraphs(command.description);
  out += section("Options") +
         escaped(
             "A value follows as --name=value or --name value. Of an option given twice the later one counts, unless "
             "it says "
             "otherwise. -h and --help print the common options, --help=all prints all of them.") +
         "\n";
  for (const auto& [group, rows] : grouped(options)) {
    out += ".SS " + escaped(group) + "\n";
    for (const Option* option : rows) out += option_item(*option);
  }
  if (command.bit == kResolve)
    out += topic_sections({"aovs", "rejection", "report", "rerender", "conventions", "presets", "exit-codes"}) +
           files_section();
  else if (command.bit == kCompare)
    out += topic_sections({"metrics", "conventions", "exit-codes"});
  else if (command.bit == kMeasure)
    out += topic_sections({"presets", "metrics", "conventions", "exit-codes"});
  else if (command.bit == kSynth)
    out += topic_sections({"scenes", "patterns", "exit-codes"});
  else if (command.bit == kJitter)
    out += topic_sections({"patterns", "jitter-conventions", "exit-codes"});
  else
    out += topic_sections({"conventions", "exit-codes"});
  return out + examples_section(command.examples) + see_also(page);
}

}  // namespace

std::string manual_page(const Command* command) { return command ? command_page(*command) : program_page(); }

}  // namespace varve::cli
