// --repair-motion and varve probe --vectors as a user meets them: the scenes whose vectors are wrong, and those where
// they are right.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/json.h"
#include "paths.h"
#include "scene_cli.h"

namespace varve::test {
namespace {

class RepairCli : public SceneCli {
 protected:
  /// What probe says of the vectors of a scene.
  JsonValue table(const std::string& scene, const std::string& frames, const Arguments& more = {}) const {
    Arguments line = {"probe", "in/" + scene + ".####.exr", "-f", frames, "--vectors", "4", "--json"};
    line.insert(line.end(), more.begin(), more.end());
    const Outcome outcome = run_varve(line, folder.path());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::optional<JsonValue> json = parse_json(outcome.out);
    const JsonValue* vectors = json ? json->find("vectors") : nullptr;
    return vectors ? *vectors : JsonValue{};
  }

  /// Sentences of a table, in its order.
  static std::vector<std::string> sentences(const JsonValue& table) {
    std::vector<std::string> found;
    if (const JsonValue* objects = table.find("objects"))
      for (const JsonValue& object : objects->items)
        if (const JsonValue* s = object.find("sentence"); s && !s->text.empty()) found.push_back(s->text);
    return found;
  }
};

struct Failing {
  const char *scene, *frames, *says;
};

TEST_F(RepairCli, EveryWayThatVectorsFailIsNamedByObject) {
  for (const Failing& f : {Failing{"vectors-cloth", "8-9", "object 3: vectors are off by"},
                           Failing{"vectors-matrix", "8-9", "object 2: vectors are off by"},
                           Failing{"vectors-ocean", "7-10", "object 3: vectors are off by"},
                           Failing{"vectors-vegetation", "8-9", ": vectors are zero but its pixels move by about 2."},
                           Failing{"vectors-skinned", "12-13", "object 2: vectors are off by about 140"},
                           Failing{"sky-zero", "8-9", "object 1: vectors are zero but its pixels move by about 4."}}) {
    synth(f.scene, f.frames, {"--size", "320x180"});
    const std::vector<std::string> found = sentences(table(f.scene, f.frames));
    ASSERT_FALSE(found.empty()) << f.scene;
    EXPECT_NE(found.front().find(f.says), std::string::npos) << f.scene << ": " << found.front();
  }
}

TEST_F(RepairCli, RightVectorsAreNotAccused) {
  for (const std::string scene : {"quality-all", "shadow", "crossing", "stochastic-alpha", "fence", "teleport"}) {
    synth(scene, "8-10", {"--size", "160x90"});
    for (const std::string& sentence : sentences(table(scene, "8-10"))) ADD_FAILURE() << scene << ": " << sentence;
  }
}

TEST_F(RepairCli, VectorsOfARealShotAreNotAccused) {
  const std::string shot = VARVE_DATA "/courtyard/jit/";
  if (!std::filesystem::exists(shot)) GTEST_SKIP() << "no development data";
  const Outcome outcome = run_varve(
      {"probe", shot + "frame.####.exr", "--jitter", shot + "jitter.csv", "--vectors", "15", "--json"}, folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::optional<JsonValue> json = parse_json(outcome.out);
  ASSERT_TRUE(json && json->find("vectors"));
  for (const std::string& sentence : sentences(*json->find("vectors"))) ADD_FAILURE() << sentence;
}

TEST_F(RepairCli, RightVectorsResolveToTheSamePicture) {
  synth("quality-all", "6-10", {"--size", "160x90"});
  for (const std::string preset : {"salvi", "standard"}) {
    ASSERT_EQ(resolve_into("in/quality-all.####.exr", preset + "off", {"--preset", preset}, {}).code, 0);
    const Outcome on = resolve_into("in/quality-all.####.exr", preset + "on", {"--preset", preset},
                                    {"--repair-motion", "on", "--report", preset + ".json"});
    ASSERT_EQ(on.code, 0) << on.err;
    EXPECT_EQ(on.err.find("of the vectors wrong"), std::string::npos) << on.err;
    EXPECT_EQ(run_varve({"compare", preset + "off/o.####.exr", preset + "on/o.####.exr"}, folder.path()).code, 0)
        << preset;
  }
}

TEST_F(RepairCli, OneFrameOnlyIsSaid) {
  synth("crossing", "3");
  const Outcome outcome = run_varve({"probe", "in/crossing.####.exr", "--vectors", "3"}, folder.path());
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("no two frames are neighbors"), std::string::npos);
}

TEST_F(RepairCli, EveryAccumulatorRepairsWithTheSameBytesForAnyThreads) {
  synth("vectors-matrix", "7-10", {"--size", "160x90"});
  for (const std::string accumulator : {"recursive", "two-sided", "gather"}) {
    const Arguments choice = {"--accumulator", accumulator, "--preset", accumulator == "gather" ? "draft" : "salvi"};
    const auto run = [&](const std::string& to, const Arguments& more) {
      const Outcome outcome = resolve_into("in/vectors-matrix.####.exr", to, choice, more);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
    };
    run(accumulator + "off", {"--repair-motion", "off"});
    run(accumulator + "check", {"--repair-motion", "check"});
    run(accumulator + "1", {"--repair-motion", "on", "-j", "1"});
    run(accumulator + "3", {"--repair-motion", "on", "-j", "3", "--report", accumulator + ".json"});
    EXPECT_TRUE(bytes_of(path(accumulator + "1", 9)) == bytes_of(path(accumulator + "3", 9))) << accumulator;
    EXPECT_FALSE(bytes_of(path(accumulator + "1", 9)) == bytes_of(path(accumulator + "off", 9))) << accumulator;
    const std::string report = bytes_of(folder / (accumulator + ".json"));
    EXPECT_NE(report.find("\"vectors_by_search\":"), std::string::npos);
    EXPECT_EQ(
        run_varve({"compare", accumulator + "off/o.####.exr", accumulator + "check/o.####.exr"}, folder.path()).code, 0)
        << accumulator;
  }
}

TEST_F(RepairCli, WhatRestsIsRepairedByTheCamera) {
  for (const std::string where : {"note", "none"}) {
    std::filesystem::remove_all(folder / "in");
    synth("sky-zero", "8-9", {"--size", "160x90", "--cameras", where});
    for (const std::string accumulator : {"recursive", "two-sided", "gather"}) {
      const std::string name = where + accumulator;
      const Outcome outcome =
          resolve_into("in/sky-zero.####.exr", name,
                       {"--preset", accumulator == "gather" ? "draft" : "salvi", "--accumulator", accumulator},
                       {"--camera-motion", "missing", "--repair-motion", "on", "--report", name + ".json"});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const std::string report = bytes_of(folder / (name + ".json")), key = "\"vectors_by_camera\":";
      double most = 0;
      for (std::size_t at = 0; (at = report.find(key, at)) != std::string::npos;)
        most = std::max(most, std::strtod(report.c_str() + (at += key.size()), nullptr));
      EXPECT_EQ(most > 6000, where == "note") << name << ": " << most;
    }
  }
}

TEST_F(RepairCli, PartsOfASequenceAreRepairedAlike) {
  synth("vectors-matrix", "5-11", {"--size", "160x90"});
  const Arguments choice = {"--preset", "draft", "--repair-motion", "on", "--reach", "2"};
  ASSERT_EQ(resolve_into("in/vectors-matrix.####.exr", "whole", choice, {}).code, 0);
  ASSERT_EQ(resolve_into("in/vectors-matrix.####.exr", "part", choice, {"-f", "8"}).code, 0);
  EXPECT_TRUE(bytes_of(path("whole", 8)) == bytes_of(path("part", 8)));
}

TEST_F(RepairCli, PlanesShowWhatWasDone) {
  synth("vectors-matrix", "8-9", {"--size", "160x90"});
  const Outcome outcome = resolve_into("in/vectors-matrix.####.exr", "out", {"--preset", "salvi"},
                                       {"--repair-motion", "on", "--aov", "vector-residual,vector-repair"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("% of the vectors wrong"), std::string::npos) << outcome.err;
  const std::string probe = run_varve({"probe", "out/o.####.exr", "--json"}, folder.path()).out;
  EXPECT_NE(probe.find("varve.vector-repair"), std::string::npos);
  EXPECT_NE(probe.find("varve.vector-residual"), std::string::npos);
}

}  // namespace
}  // namespace varve::test
