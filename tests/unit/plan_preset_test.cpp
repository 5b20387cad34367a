// Presets and parameters as text.
#include "plan/preset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/error.h"
#include "plan/knob.h"

namespace varve {
namespace {

TEST(Knobs, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const Knob& knob : knobs()) EXPECT_TRUE(names.insert(knob.name).second) << knob.name;
}

TEST(Knobs, EveryWordIsShownAsItWasRead) {
  for (const Knob& knob : knobs())
    for (const Choice& choice : knob.value.choices) {
      Parameters parameters;
      ASSERT_TRUE(knob.value.read(parameters, choice.word));
      EXPECT_EQ(knob.value.show(parameters), choice.word) << knob.name;
    }
}

TEST(Knobs, ARefusedValueChangesNothing) {
  const std::string before = parameters_text(Parameters{});
  for (const Knob& knob : knobs()) {
    Parameters parameters;
    EXPECT_FALSE(knob.value.read(parameters, "nan")) << knob.name;
    EXPECT_FALSE(knob.value.read(parameters, "-7e99")) << knob.name;
    EXPECT_EQ(parameters_text(parameters), before);
  }
}

/// Each knob reaches a field of its own: changing one changes its own text and no other.
TEST(Knobs, AreIndependent) {
  const std::vector<Knob> table = knobs();
  for (const Knob& knob : table) {
    Parameters parameters;
    const std::string standard = knob.value.show(parameters);
    std::string other;
    for (const char* number : {"0.5", "0.25", "7", "9", "0.75"})
      if (Parameters tried; other.empty() && number != standard && knob.value.read(tried, number)) other = number;
    for (const Choice& choice : knob.value.choices)
      if (choice.word != standard) other = choice.word;
    if (!knob.value.read(parameters, other)) other = "2";  // whole numbers only
    ASSERT_TRUE(knob.value.read(parameters, other)) << knob.name;
    for (const Knob& each : table)
      EXPECT_EQ(each.value.show(parameters), &each == &knob ? other : each.value.show(Parameters{})) << each.name;
  }
}

TEST(Presets, TheDefaultParametersAreThePresetTheyName) {
  const Parameters standard;
  const Preset* preset = find_preset(standard.preset);
  ASSERT_NE(preset, nullptr);
  EXPECT_EQ(parameters_text(preset_parameters(*preset)), parameters_text(standard));
}

TEST(Presets, Salvi) {
  const Preset* salvi = find_preset("salvi");
  ASSERT_NE(salvi, nullptr);
  const Parameters p = preset_parameters(*salvi);
  EXPECT_EQ(p.preset, "salvi");
  EXPECT_EQ(p.recursive.alpha, 0.1);
  EXPECT_EQ(p.rectify.gamma, 1);
  EXPECT_EQ(p.rectify.window, 3);
  EXPECT_EQ(p.rectify.box, Box::variance);
  EXPECT_EQ(p.rectify.rule, BoxRule::clip);
  EXPECT_EQ(p.motion.dilation, Dilation::longest);
  EXPECT_NE(p.recursive.history_filter, HistoryFilter::bilinear);
}

TEST(Presets, RecipesOfTheSources) {
  const Parameters lopez = preset_parameters(*find_preset("lopez"));
  EXPECT_EQ(lopez.recursive.history_filter, HistoryFilter::catmull_rom);
  EXPECT_EQ(lopez.recursive.alpha_rule, AlphaRule::fixed);
  EXPECT_EQ(lopez.motion.dilation, Dilation::nearest);
  EXPECT_EQ(lopez.rectify.gamma, 1.5);
  EXPECT_EQ(lopez.rectify.anchor, BoxAnchor::center);
  EXPECT_EQ(lopez.recursive.weight.weighing, Weighing::luminance);
  const Parameters crytek2 = preset_parameters(*find_preset("crytek2"));
  EXPECT_EQ(crytek2.recursive.alpha, 0.5);
  EXPECT_EQ(crytek2.rectify.box, Box::none);
  EXPECT_EQ(crytek2.recursive.reject.speed, 1);
  const Parameters inside = preset_parameters(*find_preset("inside"));
  EXPECT_EQ(inside.recursive.unjitter, Unjitter::bilinear);
  EXPECT_EQ(inside.recursive.history_filter, HistoryFilter::bilinear);
  EXPECT_EQ(inside.motion.dilation, Dilation::nearest);
  EXPECT_EQ(inside.rectify.anchor, BoxAnchor::center);
  EXPECT_EQ(inside.rectify.box, Box::rounded);
  EXPECT_EQ(inside.recursive.weight.feedback, Feedback::luma);
  EXPECT_EQ(inside.fallback.motion_blur, MotionBlur::own);
}

TEST(Presets, NamesAreUniqueAndValuesAreRead) {
  std::set<std::string_view> names;
  for (const Preset& preset : presets()) {
    EXPECT_TRUE(names.insert(preset.name).second);
    EXPECT_NO_THROW(preset_parameters(preset)) << preset.name;
  }
  EXPECT_EQ(find_preset("no such preset"), nullptr);
}

TEST(ParametersText, ReadsBackToTheSameBits) {
  for (const double alpha : {0.1, 1.0 / 3, 1e-300, std::nextafter(1.0, 0.0), 1.0}) {
    Parameters parameters;
    parameters.recursive.alpha = alpha;
    parameters.rectify.window = 7;
    Parameters again;
    set_parameters(again, parameters_text(parameters));
    EXPECT_EQ(again.recursive.alpha, alpha);
    EXPECT_EQ(parameters_text(again), parameters_text(parameters));
  }
}

TEST(ParametersText, ShowsEveryKnobOnceAndShort) {
  const std::string text = std::string(" ").append(parameters_text(Parameters{})).append(" ");
  EXPECT_NE(text.find(" alpha=0.1 "), std::string::npos) << text;
  EXPECT_NE(text.find(" gamma=1 "), std::string::npos) << text;
  for (const Knob& knob : knobs()) {
    const std::string key = std::string(" ").append(knob.name).append("=");
    EXPECT_NE(text.find(key), std::string::npos) << key;
    EXPECT_EQ(text.find(key), text.rfind(key)) << key;
  }
}

TEST(SetParameters, RefusesWhatItDoesNotKnow) {
  Parameters parameters;
  for (const char* text : {"alpha", "alpha=", "=1", "alpha=2", "beta=1", "alpha=0.5 gamma=x"})
    EXPECT_THROW(set_parameters(parameters, text), Failure) << text;
  EXPECT_NO_THROW(set_parameters(parameters, ""));
  EXPECT_NO_THROW(set_parameters(parameters, "  alpha=0.5  "));
}

TEST(NumberText, IsShortAndReadsBack) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(16384), "16384");
  EXPECT_EQ(number_text(1e6), "1000000");
  EXPECT_EQ(number_text(-0.25), "-0.25");
  for (const double number : {1.0 / 3, 1e-320, 1.7976931348623157e308, 123456789.125})
    EXPECT_EQ(parse_number<double>(number_text(number)), number);
}

}  // namespace
}  // namespace varve
