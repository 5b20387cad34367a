#include "compare_options.h"

#include <charconv>
#include <cmath>

#include "option_values.h"

namespace varve::cli {
namespace {

constexpr auto kBasic = Tier::basic, kAdvanced = Tier::advanced, kExpert = Tier::expert;

constexpr Word<bool> kWindows[] = {
    {"same", false, "windows must be the same on both sides"},
    {"common", true, "compare the pixels that lie in both data windows"},
};

std::string metric_names() {
  std::string names;
  for (const Metric& metric : metrics()) names += (names.empty() ? "" : ", ") + std::string(metric.name);
  return names;
}

/// The set starts empty with the first --metrics.
Value<Settings> metrics_value() {
  return {[](Settings& s, std::string_view text) {
            MetricSet set;
            const auto add = [&set](Settings&, const std::string& name) {
              for (const Metric& metric : metrics())
                if (name == "all" || name == metric.name || (name == "fast" && !metric.slow))
                  set.set(std::size_t(metric.id));
              return name == "all" || name == "fast" || find_metric(name);
            };
            if (!list(add, "").read(s, text)) return false;
            s.compare.metrics = set;
            return true;
          },
          [](const Settings&) { return std::string("all"); },
          "all, fast (all but ssim and the FLIPs), or a list with commas of the names in `varve help metrics`",
          {}};
}

Value<Settings> limit_value(bool fail) {
  return {[fail](Settings& s, std::string_view text) {
            const std::size_t equals = text.find('=');
            if (equals == std::string_view::npos) return false;
            const Metric* metric = find_metric(text.substr(0, equals));
            const std::optional<double> value = parse_number<double>(text.substr(equals + 1));
            if (!metric || !value) return false;
            s.compare.limits.push_back({metric->id, *value, fail});
            return true;
          },
          nullptr,
          "NAME=VALUE with one of the names " + metric_names(),
          {}};
}

/// x,y,w,h.
Value<Settings> edge_value() {
  return {[](Settings& s, std::string_view text) {
            std::vector<int> numbers;
            const auto add = [&numbers](Settings&, const std::string& item) {
              const std::optional<int> number = parse_number<int>(item);
              if (number) numbers.push_back(*number);
              return number && std::abs(*number) <= 1 << 20;
            };
            if (!list(add, "").read(s, text) || numbers.size() != 4 || numbers[2] < 8 || numbers[3] < 8) return false;
            s.compare.edge = Window{numbers[0], numbers[1], numbers[0] + numbers[2], numbers[1] + numbers[3]};
            return true;
          },
          nullptr,
          "x,y,w,h in pixels of the display window, at least 8 wide and high",
          {}};
}

Value<Settings> channels_value() {
  Value<Settings> value = list(
      [](Settings& s, const std::string& name) {
        s.compare.channels.push_back(name);
        return true;
      },
      "color, all, or a list with commas of full channel names, color among them or not");
  value.read = [read = value.read](Settings& s, std::string_view text) {
    s.compare.channels.clear();
    return read(s, text);
  };
  value.show = [](const Settings&) { return std::string("color"); };
  return value;
}

template <class At>
Value<Settings> layer_value(At at) {
  return list(
      [at](Settings& s, const std::string& layer) {
        at(s).layers.push_back(layer);
        return true;
      },
      "all, or names of layers with commas between");
}

template <class At>
Value<Settings> side_map_value(At at) {
  Value<Settings> value = map_value();
  value.read = [at, read = value.read](Settings& s, std::string_view text) {
    // Read as --map does, then moved to the side it belongs to.
    if (!read(s, text)) return false;
    at(s).map.push_back(s.job.roles.map.back());
    s.job.roles.map.pop_back();
    return true;
  };
  return value;
}

void add_matching(std::vector<Option>& rows) {
  const std::string group = "What is compared";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"channels", 'c', "LIST", kCompare, kBasic, group,
       "Channels to compare. Colors are matched whatever they are called, all others by their full names.",
       channels_value()});
  add({"window", 0, "WHICH", kCompare, kBasic, group, "What happens to windows that differ.",
       word(
           [](auto& s) -> auto& { return s.compare.common_window; }, kWindows)});
  add({"nan-equal", 0, "", kCompare, kAdvanced, group, "NaN against NaN at the same place is no difference.",
       flag([](auto& s) -> auto& { return s.compare.nan_equal; })});
  add({"attributes", 0, "", kCompare, kAdvanced, group,
       "Compare attributes too, without those that differ with every run, such as dates and render times.",
       flag([](auto& s) -> auto& { return s.compare.attributes; })});
  add({"layer-a", 0, "LIST", kCompare, kAdvanced, group, "Layers of A, where they are called otherwise than in B.",
       layer_value([](auto& s) -> auto& { return s.only_a; })})
      .repeats = true;
  add({"layer-b", 0, "LIST", kCompare, kAdvanced, group, "Layers of B, likewise.",
       layer_value([](auto& s) -> auto& { return s.only_b; })})
      .repeats = true;
  add({"map-a", 0, "ROLE=CHANNEL", kCompare, kExpert, group,
       "Name the channel of a role in A, where its name does not tell.",
       side_map_value([](auto& s) -> auto& { return s.only_a; })})
      .repeats = true;
  add({"map-b", 0, "ROLE=CHANNEL", kCompare, kExpert, group, "The same for B.",
       side_map_value([](auto& s) -> auto& { return s.only_b; })})
      .repeats = true;
}

void add_judging(std::vector<Option>& rows) {
  const std::string group = "Figures and limits";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"metrics", 'm', "LIST", kCompare, kBasic, group, "Figures to measure.", metrics_value()}).topic = "metrics";
  add({"fail", 0, "NAME=VALUE", kCompare, kBasic, group,
       "Limit of a figure: exit code 1 when it does not hold. Figures of single frames must hold it in each frame; a "
       "figure that cannot be measured does not hold it.",
       limit_value(true)})
      .repeats = true;
  add({"warn", 0, "NAME=VALUE", kCompare, kBasic, group, "The same without an effect on the exit code.",
       limit_value(false)})
      .repeats = true;
  add({"white", 0, "NITS", kCompare, kExpert, group, "Luminance of the linear value 1 in cd/m2, for psnr-pu.",
       number([](auto& s) -> auto& { return s.compare.white; }, {1, 10000})});
  add({"edge", 0, "X,Y,W,H", kCompare, kAdvanced, group,
       "Measure the sharpness of the slanted edge in this window: mtf50, edge-width, edge-blur.", edge_value()});
}

void add_reports(std::vector<Option>& rows) {
  const std::string group = "Reports";
  const auto add = [&rows, group](const char* name, const char* metavar, const char* help, auto at,
                                  const char* allowed) {
    rows.push_back({name, 0, metavar, kCompare, kBasic, group, help, text(at, allowed)});
    rows.back().completes = Completes::files;
  };
  add(
      "json", "FILE", "Write all figures as JSON; - is standard output, where the tables are left out then.",
      [](auto& s) -> auto& { return s.json_file; }, "a file name, or -");
  add(
      "csv", "FILE", "Write a table with a line for each frame.", [](auto& s) -> auto& { return s.csv_file; },
      "a file name");
  add(
      "html", "FILE",
      "Write a page with plots, and with pictures of the worst frames to flip through. It needs no other file.",
      [](auto& s) -> auto& { return s.html_file; }, "a file name");
  add(
      "heat", "FOLDER", "Write for each frame where it differs, as EXR and PNG.",
      [](auto& s) -> auto& { return s.compare.heat_folder; }, "a folder");
  rows.back().completes = Completes::folders;
}

}  // namespace

void add_compare_options(std::vector<Option>& rows) {
  add_matching(rows);
  add_judging(rows);
  add_reports(rows);
}

}  // namespace varve::cli
