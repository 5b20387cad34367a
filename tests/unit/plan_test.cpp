#include "plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "base/error.h"
#include "base/json.h"
#include "plan/describe.h"
#include "support/refusal.h"

namespace varve {
namespace {

using test::message_of;

// A sequence of `frames` frames, one part, `size` x `size` pixels, half channels.
SequenceInfo sequence(const std::vector<std::string>& channels, int frames = 3, int size = 1000, bool jitter = false) {
  SequenceInfo info;
  for (int f = 1; f <= frames; ++f) info.frames.push_back(f);
  Part part;
  part.data_window = part.display_window = {0, 0, size, size};
  for (const std::string& name : channels) part.channels.push_back({name, PixelType::float16, 1, 1, false});
  info.first.frame = 1;
  info.first.files = {{"a.0001.exr", {part}, {}, 0}};
  info.first.subjects = find_subjects(info.first.files, {});
  info.first.outputs = color_outputs(info.first.files, info.first.subjects, {});
  info.frames_with_jitter = jitter ? frames : 0;
  info.jitter_source = info.camera = "none found";
  return info;
}

const std::vector<std::string> kRgb = {"B", "G", "R"};
const std::vector<std::string> kFull = {"A",          "B",          "G",         "R",         "Z",
                                        "backward.u", "backward.v", "forward.u", "forward.v", "id"};
const std::vector<std::string> kForward = {"B", "G", "R", "Z", "forward.u", "forward.v"};

const PlannedPass& pass(const Plan& plan, const std::string& name) {
  const auto found =
      std::find_if(plan.passes.begin(), plan.passes.end(), [&](const PlannedPass& p) { return p.name == name; });
  if (found == plan.passes.end()) throw std::runtime_error("no pass " + name);
  return *found;
}

std::vector<std::string> names_read(const SequenceInfo& info, const Plan& plan) {
  std::vector<std::string> names;
  for (const ChannelRef ref : plan.channels)
    names.push_back(info.first.files[0].parts[0].channels[std::size_t(ref.channel)].name);
  return names;
}

TEST(Plan, ReadsNoMoreThanTheSceneRequires) {
  const SequenceInfo info = sequence(kFull);
  Parameters parameters;
  parameters.motion.dilation = Dilation::longest;
  parameters.recursive.disocclusion = Disocclusion::window;
  const Plan plain = make_plan(info, parameters, {}, 2);
  EXPECT_FALSE(plain.use_depth);
  EXPECT_TRUE(plain.use_motion);
  EXPECT_EQ(names_read(info, plain), (std::vector<std::string>{"A", "B", "G", "R", "backward.u", "backward.v"}));
  parameters.recursive.disocclusion = Disocclusion::depth;
  const Plan tested = make_plan(info, parameters, {}, 2);
  EXPECT_TRUE(tested.use_depth);
  EXPECT_TRUE(pass(tested, "depth test").runs);
  EXPECT_EQ(names_read(info, tested).size(), 7u);
  EXPECT_GT(tested.bytes, plain.bytes);
}

TEST(Plan, NothingMovesWithoutVectors) {
  const Plan plan = make_plan(sequence(kRgb), {}, {}, 2);
  for (const char* name : {"motion", "invert forward", "dilate", "depth test", "sample weights", "diagnostics"})
    EXPECT_FALSE(pass(plan, name).runs) << name;
  for (const char* name : {"read", "sanitize", "history", "rectify", "blend", "write"})
    EXPECT_TRUE(pass(plan, name).runs) << name;
  EXPECT_FALSE(plan.use_motion || plan.use_depth || plan.use_jitter);
}

TEST(Plan, EveryPassHasAReasonAndThePlanAlwaysNamesTheSamePasses) {
  std::vector<std::string> names;
  for (const SequenceInfo& info : {sequence(kFull), sequence(kRgb), sequence(kForward, 1), sequence(kFull, 1)})
    for (const Box box : {Box::none, Box::variance}) {
      Parameters parameters;
      parameters.rectify.box = box;
      std::vector<std::string> here;
      for (const PlannedPass& p : make_plan(info, parameters, {}, 2).passes) {
        here.push_back(p.name);
        EXPECT_FALSE(p.reason.empty()) << p.name;
      }
      if (names.empty()) names = here;
      EXPECT_EQ(here, names);
    }
  EXPECT_EQ(names.front(), "read");
  EXPECT_EQ(names.back(), "write");
}

TEST(Plan, ForwardVectorsAloneAreInvertedWithDepth) {
  const SequenceInfo info = sequence(kForward);
  const Plan plan = make_plan(info, {}, {}, 2);
  EXPECT_TRUE(pass(plan, "invert forward").runs);
  EXPECT_TRUE(plan.use_depth);
  EXPECT_EQ(names_read(info, plan).size(), 6u);
}

TEST(Plan, NearestDilationFallsBackAloud) {
  Parameters parameters;
  parameters.motion.dilation = Dilation::nearest;
  const Plan with = make_plan(sequence(kFull), parameters, {}, 2);
  EXPECT_TRUE(with.use_depth);
  const Plan without = make_plan(sequence({"B", "G", "R", "backward.u", "backward.v"}), parameters, {}, 2);
  EXPECT_FALSE(without.use_depth);
  EXPECT_NE(pass(without, "dilate").reason.find("longest"), std::string::npos);
  EXPECT_TRUE(std::any_of(without.notes.begin(), without.notes.end(),
                          [](const std::string& n) { return n.find("longest") != std::string::npos; }));
}

TEST(Plan, WhatCannotBeDoneIsRefusedWithTheRemedy) {
  Parameters depth, weights;
  depth.recursive.disocclusion = Disocclusion::depth;
  weights.recursive.sample_filter = SampleFilter::gaussian;
  EXPECT_NE(message_of([&] { make_plan(sequence(kRgb), depth, {}, 2); }).find("--map depth="), std::string::npos);
  EXPECT_NE(message_of([&] { make_plan(sequence(kFull), weights, {}, 2); }).find("--jitter"), std::string::npos);
  SequenceInfo partly = sequence(kFull, 3, 100, true);
  EXPECT_TRUE(make_plan(partly, weights, {}, 2).use_jitter);
  partly.frames_with_jitter = 2;
  EXPECT_NE(message_of([&] { make_plan(partly, weights, {}, 2); }).find("2 of 3"), std::string::npos);
  Parameters unjitter, both = weights;
  unjitter.recursive.unjitter = both.recursive.unjitter = Unjitter::bilinear;
  EXPECT_NE(message_of([&] { make_plan(sequence(kFull), unjitter, {}, 2); }).find("--unjitter none"),
            std::string::npos);
  partly.frames_with_jitter = 3;
  EXPECT_TRUE(pass(make_plan(partly, unjitter, {}, 2), "unjitter").runs);
  EXPECT_NE(message_of([&] { make_plan(partly, both, {}, 2); }, ExitCode::usage).find("--sample-filter"),
            std::string::npos);
  OutputRequest output;
  output.aovs = {"banana"};
  message_of([&] { make_plan(sequence(kFull), {}, output, 2); }, ExitCode::usage);
}

TEST(Plan, FiltersThatAmplifyAreRefusedWithTheirFigures) {
  Parameters sharp;
  sharp.recursive.history_filter = HistoryFilter::cubic;
  EXPECT_TRUE(pass(make_plan(sequence(kFull), sharp, {}, 2), "history").runs);  // Catmull-Rom's constants
  sharp.recursive.cubic_c = 0.75;
  const std::string text = message_of([&] { make_plan(sequence(kFull), sharp, {}, 2); }, ExitCode::usage);
  for (const char* part : {"cubic-c 0.75", "1.029", "0.055", "bspline5"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  sharp.recursive.cubic_b = 1;  // so soft that nothing is amplified
  sharp.recursive.cubic_c = 0;
  EXPECT_TRUE(pass(make_plan(sequence(kFull), sharp, {}, 2), "history").runs);
}

TEST(Plan, MemoryFollowsTheFormula) {
  // 3 half channels in and out, color 16, two histories of 24 B per pixel.
  const std::size_t pixels = 1000 * 1000, base = std::size_t(15) << 20;
  EXPECT_EQ(make_plan(sequence(kRgb), {}, {}, 2).bytes, base + pixels * (6 + 6 + 16 + 48));
  EXPECT_EQ(make_plan(sequence(kRgb, 1000), {}, {}, 2).bytes, make_plan(sequence(kRgb, 3), {}, {}, 2).bytes);
  OutputRequest output;
  output.aovs = {"all"};
  EXPECT_GT(make_plan(sequence(kRgb), {}, output, 2).bytes, make_plan(sequence(kRgb), {}, {}, 2).bytes);
  output = {};
  output.keep_channels = false;
  EXPECT_LT(make_plan(sequence(kFull), {}, output, 2).bytes, make_plan(sequence(kFull), {}, {}, 2).bytes);
}

TEST(Plan, TwoSidedSaysHowFarItReachesAndWhatWaits) {
  Parameters parameters;
  parameters.accumulator = Accumulator::two_sided;
  const Plan both = make_plan(sequence(kFull), parameters, {}, 2), back = make_plan(sequence(kFull), {}, {}, 2);
  EXPECT_NE(pass(both, "past and future").reason.find("44 frames"), std::string::npos);
  EXPECT_NE(pass(both, "past and future").reason.find("in memory"), std::string::npos);
  EXPECT_TRUE(both.use_forward);
  EXPECT_FALSE(both.use_depth);
  const std::vector<std::string> read = names_read(sequence(kFull), both);
  EXPECT_NE(std::find(read.begin(), read.end(), "forward.v"), read.end());
  // Color, weight and spread of the future of 44 frames, 24 B per pixel each.
  EXPECT_GE(both.bytes, back.bytes + std::size_t(44) * 24 * 1000 * 1000);
  EXPECT_GT(both.seconds_per_frame, 2 * back.seconds_per_frame);
  OutputRequest spilled;
  spilled.spill_folder = "elsewhere";
  EXPECT_LT(make_plan(sequence(kFull), parameters, spilled, 2).bytes, back.bytes + std::size_t(100) * 1000 * 1000);
  message_of([&] { make_plan(sequence(kFull), {}, spilled, 2); }, ExitCode::usage);
  // One direction of vectors is inverted, with depth where there is one.
  EXPECT_TRUE(make_plan(sequence(kForward), parameters, {}, 2).use_depth);
  // A single frame has neighbors to look at.
  EXPECT_TRUE(pass(make_plan(sequence(kFull, 1), parameters, {}, 2), "rectify").runs);
  // Planes that it cannot fill are refused, and not part of "all".
  const auto named = [](const char* name) {
    OutputRequest output;
    output.aovs = {name};
    return output;
  };
  message_of([&] { make_plan(sequence(kFull), parameters, named("prediction"), 2); }, ExitCode::usage);
  message_of([&] { make_plan(sequence(kFull), {}, named("count-future"), 2); }, ExitCode::usage);
  for (const Aov* aov : planned_aovs(named("all"), Accumulator::two_sided)) EXPECT_NE(aov->name, "prediction");
  for (const Aov* aov : planned_aovs(named("all"), Accumulator::recursive)) EXPECT_NE(aov->name, "count-past");
}

TEST(Plan, TimeGrowsWithPixelsAndFallsWithThreads) {
  const double one = make_plan(sequence(kFull), {}, {}, 1).seconds_per_frame;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(make_plan(sequence(kFull), {}, {}, 4).seconds_per_frame, one / 4, 1e-12);
  EXPECT_NEAR(make_plan(sequence(kFull, 3, 2000), {}, {}, 1).seconds_per_frame, one * 4, one * 1e-9);
}

TEST(Describe, JsonIsValidAndHoldsThePlan) {
  SequenceInfo info = sequence(kFull);
  info.first.files[0].path = "odd \"name\"\n\xFF.exr";
  const Plan plan = make_plan(info, {}, {}, 2);
  const std::vector<ChannelStatistics> statistics = {{1, "", "R", "R", 0, 1e300 * 1e300, 0.5, 10, 1, 2}};
  const std::string text = describe_json(info, plan, statistics);
  const auto json = parse_json(text);
  ASSERT_TRUE(json) << text;
  for (const char* name :
       {"frames", "files", "windows", "layers", "jitter", "camera", "plan", "statistics", "findings", "notes"})
    EXPECT_TRUE(json->find(name)) << name;
  EXPECT_EQ(json->find("frames")->find("list")->text, "1-3");
  EXPECT_EQ(json->find("plan")->find("passes")->items.size(), plan.passes.size());
  const JsonValue& channels = *json->find("files")->items[0].find("parts")->items[0].find("channels");
  ASSERT_EQ(channels.items.size(), kFull.size());
  EXPECT_EQ(channels.items[4].find("role")->text, "depth");
  EXPECT_FALSE(channels.items[4].find("read")->boolean);
  EXPECT_EQ(channels.items[9].find("role")->text, "id");  // found by its name, read only by what asks for it
  EXPECT_FALSE(channels.items[9].find("read")->boolean);
  EXPECT_EQ(text, describe_json(info, plan, statistics));
}

TEST(Describe, TextFitsTheTerminal) {
  const SequenceInfo info = sequence(kFull);
  const std::string text = describe_text(info, make_plan(info, {}, {}, 2), {});
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    EXPECT_LE(end - begin, 100u) << text.substr(begin, end - begin);
    EXPECT_FALSE(end > begin && text[end - 1] == ' ');
  }
  for (const char* word : {"frames", "Layers to resolve", "Plan", "MiB", "convention nuke", "backward.u"})
    EXPECT_NE(text.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace varve
