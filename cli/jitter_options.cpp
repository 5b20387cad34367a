#include "jitter_options.h"

#include "option_values.h"

namespace varve::cli {
namespace {

constexpr Word<bool> kFormats[] = {
    {"csv", false, "comment lines, a header, and a line for each frame; `varve resolve --jitter` reads it"},
    {"json", true, "one object, for scripts inside a renderer"},
};
constexpr auto kBasic = Tier::basic, kAdvanced = Tier::advanced;

Value<Settings> convention_word() {
  Value<Settings> value;
  for (const JitterConvention& row : jitter_conventions())
    value.choices.push_back({std::string(row.name), std::string(row.x) + ", " + std::string(row.y)});
  value.allowed = choices_text(value.choices);
  value.read = [](Settings& s, std::string_view text) {
    for (const JitterConvention& row : jitter_conventions())
      if (row.name == text) {
        s.jitter.convention = row.name;
        return true;
      }
    return false;
  };
  value.show = [](const Settings& s) { return std::string(s.jitter.convention); };
  return value;
}

}  // namespace

void add_jitter_options(std::vector<Option>& rows) {
  const auto add = [&rows](const char* group, Option option) -> Option& {
    option.commands = kJitter;
    option.group = group;
    return rows.emplace_back(std::move(option));
  };
  const char* const files = "Input and output";
  add(files, {"output", 'o', "FILE", 0, kBasic, "", "File to write; without it the list goes to standard output.",
              text(
                  [](auto& s) -> auto& { return s.jitter_file; }, "a file name")})
      .completes = Completes::files;
  add(files, {"format", 0, "FORMAT", 0, kBasic, "", "Form of the list.",
              word(
                  [](auto& s) -> auto& { return s.jitter_json; }, kFormats)});
  const char* const positions = "Positions";
  add(positions, {"count", 0, "FRAMES", 0, kBasic, "",
                  "Frames to list; also the length of a pattern that is given without one and has none of its own.",
                  number([](auto& s) -> auto& { return s.jitter.count; }, {1, 1 << 20})});
  add(positions, {"first", 0, "FRAME", 0, kBasic, "",
                  "Number of the first frame. Frame 1 always has the first point, as with `varve resolve --jitter "
                  "PATTERN:N`, and the points follow in turns.",
                  number([](auto& s) -> auto& { return s.jitter.first; }, {-1e9, 1e9})});
  add(positions, {"amplitude", 0, "FACTOR", 0, kBasic, "",
                  "Multiplies all positions. 1 fills the pixel; less flickers less and resolves less; 0 is no jitter.",
                  number([](auto& s) -> auto& { return s.jitter.amplitude; }, {0, 1})});
  add(positions, {"centered", 0, "", 0, kBasic, "",
                  "Subtract the mean of one round, so that the picture is not shifted; the comment lines tell it.",
                  flag([](auto& s) -> auto& { return s.jitter.centered; })});
  add(positions, {"seed", 0, "NUMBER", 0, kAdvanced, "", "Of the patterns made by chance.",
                  number([](auto& s) -> auto& { return s.jitter.seed; }, {0, 2147483647})});
  add(positions, {"direction", 0, "DEGREES", 0, kAdvanced, "",
                  "Where things move on screen, for motion-perpendicular: 0 is to the right, 90 is down.",
                  number([](auto& s) -> auto& { return s.jitter.direction; }, {-360, 360})});
  const char* const renderer = "Renderer";
  add(renderer, {"convention", 0, "NAME", 0, kBasic, "",
                 "Numbers to list: what varve reads, or what a renderer is told; see `varve help jitter-conventions`.",
                 convention_word()})
      .topic = "jitter-conventions";
  add(renderer,
      {"size", 0, "WxH", 0, kBasic, "", "Pixels of the picture, for the conventions of renderers.",
       size_value([](Settings& s, int width, int height) { s.jitter.width = width, s.jitter.height = height; })});
}

}  // namespace varve::cli
