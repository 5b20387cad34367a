// --channels: which layers and channels a name means, and what is refused.
#include "exr/channel_names.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/refusal.h"

namespace varve {
namespace {

using test::message_of;

Part part_of(const std::vector<std::string>& channels, const std::string& name = "", const std::string& view = "") {
  Part part;
  part.name = name;
  part.view = view;
  for (const std::string& channel : channels) part.channels.push_back({channel, PixelType::float16, 1, 1, false});
  return part;
}

std::vector<FileHeader> one_file(std::vector<Part> parts) { return {FileHeader{"x.exr", std::move(parts), {}, 0}}; }

RoleRequest asking(std::vector<std::string> channels, ChannelWeights weights = ChannelWeights::beauty) {
  RoleRequest request;
  request.channels = std::move(channels);
  request.channel_weights = weights;
  return request;
}

// "layer: R G B A" of each companion; "-" where a place is free, "values" before those that stand alone.
std::vector<std::string> texts(const std::vector<FileHeader>& files, const Subject& subject) {
  std::vector<std::string> lines;
  for (const Companion& companion : subject.companions) {
    std::string line = companion.color ? companion.layer + ":" : "values:";
    for (const auto& ref : companion.channels)
      line += " " + (ref ? files[0].parts[std::size_t(ref->part)].channels[std::size_t(ref->channel)].name : "-");
    lines.push_back(line);
  }
  return lines;
}

using Lines = std::vector<std::string>;

std::vector<FileHeader> cycles() {
  return one_file({part_of({"V.Combined.R",       "V.Combined.G", "V.Combined.B", "V.Combined.A", "V.Depth.Z",
                            "V.Vector.X",         "V.Vector.Y",   "V.Vector.Z",   "V.Vector.W",   "V.Normal.X",
                            "V.Normal.Y",         "V.Normal.Z",   "V.AO.R",       "V.AO.G",       "V.AO.B",
                            "V.DiffDir.R",        "V.DiffDir.G",  "V.DiffDir.B",  "V.DiffInd.R",  "V.DiffInd.G",
                            "V.DiffInd.B",        "V.IndexOB.X",  "V.UV.U",       "V.UV.V",       "V.CryptoObject00.r",
                            "V.CryptoObject00.g", "shadow",       "V.Mask.Y",     "V.Tangent.X",  "V.Tangent.Y"})});
}

TEST(Channels, NamesByTheirEndAndPatterns) {
  const std::vector<FileHeader> files = cycles();
  const auto found = [&](std::vector<std::string> names) {
    return texts(files, find_subjects(files, asking(std::move(names))).at(0));
  };
  EXPECT_EQ(found({"ao"}), (Lines{"V.AO: V.AO.R V.AO.G V.AO.B -"}));
  EXPECT_EQ(found({"V.AO", "AO", "V.AO.R"}), (Lines{"V.AO: V.AO.R V.AO.G V.AO.B -"})) << "a channel is taken once";
  EXPECT_EQ(found({"AO.G"}), (Lines{"V.AO: - V.AO.G - -"}));
  EXPECT_EQ(found({"Diff*"}), (Lines{"V.DiffDir: V.DiffDir.R V.DiffDir.G V.DiffDir.B -",
                                     "V.DiffInd: V.DiffInd.R V.DiffInd.G V.DiffInd.B -"}));
  EXPECT_EQ(found({"Mask", "shadow", "diffd?r"}),
            (Lines{"V.DiffDir: V.DiffDir.R V.DiffDir.G V.DiffDir.B -", "values: shadow V.Mask.Y - -"}));
  EXPECT_TRUE(find_subjects(files, {}).at(0).companions.empty());
}

TEST(Channels, PatternsLeaveOutWhatCannotBeAveragedAndSaySo) {
  const std::vector<FileHeader> files = cycles();
  const Subject subject = find_subjects(files, asking({"V.*"})).at(0);
  EXPECT_EQ(texts(files, subject),
            (Lines{"V.AO: V.AO.R V.AO.G V.AO.B -", "V.DiffDir: V.DiffDir.R V.DiffDir.G V.DiffDir.B -",
                   "V.DiffInd: V.DiffInd.R V.DiffInd.G V.DiffInd.B -", "values: V.Mask.Y - - -"}));
  for (const char* name : {"V.Combined.R", "V.Depth.Z", "V.Vector.W", "V.Normal.X", "V.IndexOB.X", "V.UV.U",
                           "V.CryptoObject00.r", "V.Tangent.X"})
    EXPECT_NE(subject.notes.back().find(name), std::string::npos) << name << " in " << subject.notes.back();
}

TEST(Channels, WhatCannotBeAveragedIsRefusedWithTheReason) {
  const std::vector<FileHeader> files = cycles();
  const auto refusal = [&](const char* name) {
    return message_of([&] { find_subjects(files, asking({name})); }, ExitCode::inconsistent);
  };
  const std::vector<std::pair<const char*, const char*>> cases = {{"Depth", "depth"},
                                                                  {"V.Depth.Z", "depth"},
                                                                  {"Vector", "motion"},
                                                                  {"Normal", "normal"},
                                                                  {"IndexOB", "ids"},
                                                                  {"UV", "uv"},
                                                                  {"CryptoObject00", "ids"},
                                                                  {"Tangent", "X and Y"},
                                                                  {"Combined", "already"},
                                                                  {"nothing", "there is no layer or channel"},
                                                                  {"no*such", "there is no layer or channel"}};
  for (const auto& [name, reason] : cases) {
    EXPECT_NE(refusal(name).find(reason), std::string::npos) << name << ": " << refusal(name);
    EXPECT_NE(refusal(name).find(name), std::string::npos) << refusal(name);
  }
}

TEST(Channels, SubsampledChannelsAreRefused) {
  std::vector<FileHeader> files = one_file({part_of({"R", "G", "B", "AO"})});
  files[0].parts[0].channels[3].x_sampling = 2;
  EXPECT_NE(message_of([&] { find_subjects(files, asking({"AO"})); }, ExitCode::inconsistent).find("subsampled"),
            std::string::npos);
}

TEST(Channels, CompanionsGoWithTheLayerTheyLieInAndMayLieInOtherParts) {
  const std::vector<FileHeader> files =
      one_file({part_of({"fg.Combined.R", "fg.Combined.G", "fg.Combined.B", "fg.Light.R", "fg.Light.G", "fg.Light.B",
                         "bg.Combined.R", "bg.Combined.G", "bg.Combined.B", "bg.Light.R", "bg.Light.G", "bg.Light.B"}),
                part_of({"R", "G", "B"}, "shine")});
  RoleRequest request = asking({"Light", "shine"});
  request.layers = {"fg", "bg"};
  const std::vector<Subject> found = find_subjects(files, request);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(texts(files, found[0]), (Lines{"fg.Light: fg.Light.R fg.Light.G fg.Light.B -", "shine: R G B -"}));
  EXPECT_EQ(texts(files, found[1]), (Lines{"bg.Light: bg.Light.R bg.Light.G bg.Light.B -"}));
  EXPECT_EQ(parts_of(found[0]), (std::vector<int>{0, 1}));
  EXPECT_EQ(parts_of(found[1]), (std::vector<int>{0}));
}

TEST(Channels, OwnWeightsMakeSubjectsWithTheMotionOfTheColor) {
  std::vector<FileHeader> files = cycles();
  RoleRequest request = asking({"AO", "shadow", "Mask"}, ChannelWeights::own);
  const std::vector<Subject> found = find_subjects(files, request);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_TRUE(found[0].companions.empty());
  EXPECT_EQ(found[1].layer, "V.AO");
  EXPECT_TRUE(found[1].color[0] && found[1].color[1] && found[1].color[2] && !found[1].color[3]);
  EXPECT_EQ(found[2].layer, "shadow");
  EXPECT_TRUE(!found[2].color[0] && found[2].color[1]);
  EXPECT_EQ(found[3].layer, "V.Mask.Y");
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(found[i].backward, found[0].backward);
    EXPECT_EQ(found[i].depth, found[0].depth);
    EXPECT_EQ(found[i].convention, found[0].convention);
    EXPECT_TRUE(found[i].companions.empty());
  }
}

TEST(Channels, LongPatternsTakeNoTimeWorthMentioning) {
  const std::vector<FileHeader> files = one_file({part_of({"R", "G", "B", std::string(200, 'a')})});
  std::string pattern;
  for (int i = 0; i < 100; ++i) pattern += "*a";
  EXPECT_EQ(find_subjects(files, asking({pattern})).at(0).companions.size(), 1u);
  EXPECT_THROW(find_subjects(files, asking({pattern + "b"})), Failure);
}

}  // namespace
}  // namespace varve
