#include "measure_options.h"

#include "option_values.h"
#include "plan/preset.h"

namespace varve::cli {
namespace {

constexpr auto kBasic = Tier::basic, kAdvanced = Tier::advanced;

Value<Settings> presets_value() {
  Value<Settings> value = list(
      [](Settings& s, const std::string& name) {
        if (name == "all")
          for (const Preset& preset : presets()) s.presets.emplace_back(preset.name);
        else if (find_preset(name))
          s.presets.push_back(name);
        else
          return false;
        return true;
      },
      "all, or names of presets with commas between; see varve help presets");
  value.choices.push_back({"all", "every preset"});
  for (const Preset& preset : presets())
    value.choices.push_back({std::string(preset.name), std::string(preset.description)});
  return value;
}

/// Checked when all presets are known.
template <class At>
Value<Settings> words_value(At at, const char* allowed) {
  return {[at](Settings& s, std::string_view text) {
            at(s).emplace_back(text);
            return text.find('=') != std::string_view::npos;
          },
          nullptr,
          allowed,
          {}};
}

void add_settings(std::vector<Option>& rows) {
  const std::string group = "What is measured";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"reference", 'r', "PATTERN", kMeasure, kBasic, group,
       "What IN should look like, frame by frame. Frames that it lacks are resolved but not scored.",
       Value<Settings>{[](Settings& s, std::string_view text) {
                         s.measure.reference = SequencePattern::parse(text);
                         return true;
                       },
                       nullptr,
                       "a file name such as ref.####.exr",
                       {}}})
      .completes = Completes::files;
  add({"presets", 'p', "LIST", kMeasure, kBasic, group, "Presets to measure; without it all of them.",
       presets_value()});
  rows.back().topic = "presets";
  add({"sweep", 0, "NAME=LIST", kMeasure, kBasic, group,
       "Values of a parameter, with commas between. Given more than once, every combination is measured. The names are "
       "the long options of `varve resolve`.",
       words_value(
           [](auto& s) -> auto& { return s.sweeps; }, "a parameter with its values, such as gamma=0.5,1,2")})
      .repeats = true;
  add({"setting", 0, "VALUES", kMeasure, kBasic, group,
       "One further setting beside the combinations, with blanks between its values.",
       words_value(
           [](auto& s) -> auto& { return s.singles; }, "values of parameters, such as 'box=none alpha=0.2'")})
      .repeats = true;
  add({"leave-out", 0, "", kMeasure, kAdvanced, group,
       "With --reference: score without it as well, and print how well both rankings agree.",
       flag([](auto& s) -> auto& { return s.measure.leave_out; })});
}

void add_reports(std::vector<Option>& rows) {
  const std::string times = "Times and choice", group = "Reports";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"repeats", 0, "COUNT", kMeasure, kBasic, times, "Runs of each setting, in turns; the median counts.",
       number([](auto& s) -> auto& { return s.measure.repeats; }, {1, 1000})});
  add({"baseline", 0, "NAME", kMeasure, kAdvanced, times,
       "Setting that times are divided by, as the table calls it. Without it the preset standard, or the first "
       "setting.",
       text(
           [](auto& s) -> auto& { return s.measure.baseline; }, "the name of a setting")});
  add({"within", 0, "PERCENT", kMeasure, kBasic, times,
       "How much more squared error than the least one the recommended setting may have. 0 recommends the best.",
       number([](auto& s) -> auto& { return s.measure.within; }, {0, 10000})});
  add({"scratch", 0, "FOLDER", kMeasure, kAdvanced, times,
       "Where the runs write; each is removed before the next one. Without it $TMPDIR, or /tmp.",
       text(
           [](auto& s) -> auto& { return s.measure.scratch; }, "a folder")})
      .completes = Completes::folders;
  add({"json", 0, "FILE", kMeasure, kBasic, group,
       "Write all figures as JSON; - is standard output, where the table is left out then.",
       text(
           [](auto& s) -> auto& { return s.json_file; }, "a file name, or -")})
      .completes = Completes::files;
  add({"csv", 0, "FILE", kMeasure, kBasic, group, "Write a table with a line for each setting.",
       text(
           [](auto& s) -> auto& { return s.csv_file; }, "a file name")})
      .completes = Completes::files;
  add({"plot", 0, "FILE", kMeasure, kBasic, group, "Write a plot of error against time, as .svg or .png.",
       text(
           [](auto& s) -> auto& { return s.plot_file; }, "a file name that ends in .svg or .png")})
      .completes = Completes::files;
}

}  // namespace

void add_measure_options(std::vector<Option>& rows) {
  add_settings(rows);
  add_reports(rows);
}

}  // namespace varve::cli
