// The table of features: every number once, and every option, word and command that it names is there.
#include "plan/feature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "base/error.h"
#include "help.h"
#include "option.h"
#include "paths.h"

namespace varve::cli {
namespace {

/// What follows a mark, up to the end of the word.
std::vector<std::string> words_after(std::string_view text, std::string_view mark) {
  std::vector<std::string> words;
  for (std::size_t at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at)) {
    at += mark.size();
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-=.", at);
    words.emplace_back(text.substr(at, end == std::string_view::npos ? end : end - at));
  }
  return words;
}

TEST(Features, EveryNumberIsThereOnceAndInOrder) {
  std::map<FeatureGroup, int> last;
  for (const Feature& feature : features()) {
    EXPECT_EQ(feature.number, ++last[feature.group]) << feature.what;
    EXPECT_FALSE(feature.what.empty() || feature.how.empty()) << feature_name(feature);
    EXPECT_FALSE(feature.what.ends_with('.') || feature.how.ends_with('.')) << feature_name(feature);
    EXPECT_EQ(feature.sources.empty(), feature.group == FeatureGroup::beyond) << feature_name(feature);
    EXPECT_EQ(feature.sources.find_first_not_of("SLYWP,"), std::string_view::npos) << feature_name(feature);
  }
  EXPECT_EQ(last[FeatureGroup::system], 8);
  EXPECT_EQ(last[FeatureGroup::technique], 126);
  EXPECT_EQ(last[FeatureGroup::beyond], 13);
}

TEST(Features, NumbersAreThoseOfTheProjectsList) {
  std::ifstream list(VARVE_DATA "/../features.md");
  if (!list) GTEST_SKIP() << "no list of features beside the development data";
  std::set<int> numbers;
  for (std::string line; std::getline(list, line);)
    if (int number = 0; std::sscanf(line.c_str(), "| %d |", &number) == 1) numbers.insert(number);
  std::set<int> here;
  for (const Feature& feature : features())
    if (feature.group == FeatureGroup::technique) here.insert(feature.number);
  EXPECT_EQ(here, numbers);
}

TEST(Features, EveryOptionWordAndCommandNamedExists) {
  const std::vector<Option> options = option_table();
  const std::vector<Command> commands = command_table();
  int named = 0;
  for (const Feature& feature : features()) {
    for (const std::string& word : words_after(feature.how, "--")) {
      const std::string name = word.substr(0, word.find('='));
      const auto option = std::ranges::find(options, name, &Option::name);
      ASSERT_NE(option, options.end()) << feature_name(feature) << ": --" << name;
      ++named;
      if (name.size() == word.size()) continue;
      bool accepted = false;  // options of several commands may share a name
      for (const Option& each : options) {
        Settings settings;
        accepted = accepted || (each.name == name && each.value.read(settings, word.substr(name.size() + 1)));
      }
      EXPECT_TRUE(accepted) << feature_name(feature) << ": --" << word;
    }
    for (const std::string& word : words_after(feature.how, "`varve ")) {
      EXPECT_NE(find_command(commands, word), nullptr) << feature_name(feature) << ": varve " << word;
      ++named;
    }
    if (feature.reach == Reach::option) {
      EXPECT_TRUE(feature.how.find("--") != std::string_view::npos ||
                  feature.how.find("`varve") != std::string_view::npos)
          << feature_name(feature);
    }
  }
  EXPECT_GT(named, 60);
}

TEST(Features, HelpPrintsEachRow) {
  for (const Topic& topic : topics()) {
    if (topic.name != "features") continue;
    EXPECT_EQ(topic.rows.size(), features().size());
    const std::string text = topic_text(topic);
    for (const Feature& feature : features())
      EXPECT_NE(text.find("\n  " + feature_name(feature) + " "), std::string::npos) << feature_name(feature);
    return;
  }
  FAIL() << "no topic features";
}

TEST(Presets, HelpTellsEveryKnobOfEveryPreset) {
  for (const Topic& topic : topics()) {
    if (topic.name != "presets") continue;
    for (const Knob& knob : knobs()) {
      const auto row =
          std::ranges::find(topic.rows, "--" + std::string(knob.name), [](const auto& r) { return r.first; });
      ASSERT_NE(row, topic.rows.end()) << knob.name;
    }
    const auto filter =
        std::ranges::find(topic.rows, std::string("--history-filter"), [](const auto& r) { return r.first; });
    EXPECT_NE(filter->second.find("bilinear: crytek2, inside"), std::string::npos) << filter->second;
    return;
  }
  FAIL() << "no topic presets";
}

}  // namespace
}  // namespace varve::cli
