// T13 to T20: sums of lights, alpha, depths, windows, threads and chunks, half vectors, ends and gaps.
#include <cmath>

#include "acceptance.h"

namespace varve::test {
namespace {

/// Detail and noise that move together.
Seen moving(glm::dvec2 at, int f) {
  const glm::dvec2 v(0.7, -0.3);
  const glm::dvec2 p = at - v * double(f);
  glm::vec4 c = texture(p);
  const bool bright = std::fmod(p.x + 400, 9) < 2;
  c *= float((bright ? 8.0 : 1.0) * (0.8 + 0.4 * chance(unsigned(at.x), unsigned(at.y), unsigned(f))));
  c.a = 1;
  return {c, 1, 8, -v, v};
}

TEST_F(Acceptance, T13_LightsAddUpToTheBeautyToAMillionth) {
  const FileOptions options{.data = {0, 0, 40, 28}};
  std::filesystem::create_directories(folder / "in");
  for (int f = 1; f <= 6; ++f) {
    FrameFile frame = frame_of(moving, f, options);
    for (const char* c : {"R", "G", "B"}) {
      Plane<float> key(options.data), fill(options.data);
      Plane<float>& beauty = frame.channels[c];
      each_pixel(options.data, [&](int x, int y) {
        key.at(x, y) = float(double(beauty.at(x, y)) * chance(unsigned(x), unsigned(y), unsigned(f), 5));
        fill.at(x, y) = beauty.at(x, y) - key.at(x, y);
        beauty.at(x, y) = key.at(x, y) + fill.at(x, y);
      });
      frame.channels[std::string("key.") + c] = std::move(key);
      frame.channels[std::string("fill.") + c] = std::move(fill);
    }
    write_frame_file(folder / ("in/in." + frame_number(f) + ".exr"), frame);
  }
  int kept = 0;
  for (const Preset& preset : presets()) {
    const Outcome outcome = resolve("in", "out", {"-p", std::string(preset.name), "--channels", "key,fill"});
    if (outcome.code == 2) {  // refused with the remedy, never done wrongly
      EXPECT_NE(outcome.err.find("--channel-weights own"), std::string::npos) << preset.name << outcome.err;
      continue;
    }
    ASSERT_EQ(outcome.code, 0) << preset.name << outcome.err;
    ++kept;
    double worst = 0;
    for (int f = 1; f <= 6; ++f) {
      const ReadFile out = read("out", f);
      each_pixel(out.data, [&](int x, int y) {
        for (const std::string c : {"R", "G", "B"}) {
          const double beauty = double(out[c].at(x, y));
          const double sum = double(out["key." + c].at(x, y)) + double(out["fill." + c].at(x, y));
          worst = std::max(worst, std::fabs(sum - beauty) / std::fabs(beauty));
        }
      });
    }
    EXPECT_LE(worst, 1e-6) << preset.name;
  }
  EXPECT_GE(kept, 6);
}

TEST_F(Acceptance, T14_LightWithoutAlphaStaysAndPremultipliedEdgesHaveNoFringe) {
  const glm::dvec2 v(0.4, 0.25);
  // A flame without coverage on the left, a disk whose edge covers partly on the right.
  const World world = [&](glm::dvec2 at, int f) {
    if (at.x < 20) {
      const float fire = float(2 + chance(unsigned(at.x), unsigned(at.y), unsigned(f)));
      return Seen{{fire, fire * 0.5f, 0.125f, 0}, 1, 8, {}, {}};
    }
    const glm::dvec2 d = at - v * double(f) - glm::dvec2(42, 14);
    const double cover = std::min(1.0, std::max(0.0, 8 - std::sqrt(d.x * d.x + d.y * d.y)));
    return Seen{glm::vec4(0.5f, 0.25f, 2.0f, 1.0f) * float(cover), 2, cover > 0 ? 5.0f : 16.0f, -v, v};
  };
  write("in", world, 1, 6, {.data = {0, 0, 64, 32}});
  for (const Preset& preset : presets()) {
    resolve_well("in", "out", {"-p", std::string(preset.name)});
    const ReadFile out = read("out", 5);
    for (int y = 4; y < 28; ++y) {
      for (int x = 4; x < 16; ++x) {
        ASSERT_EQ(out["A"].at(x, y), 0.0f) << preset.name;
        ASSERT_EQ(out["B"].at(x, y), 0.125f) << preset.name;
        ASSERT_NEAR(out["R"].at(x, y), 2.5f, 0.51f) << preset.name;
      }
      int partly = 0;
      for (int x = 26; x < 60; ++x) {
        const float a = out["A"].at(x, y);
        ASSERT_TRUE(a >= 0 && a <= 1) << preset.name << " " << a;
        ASSERT_NEAR(out["R"].at(x, y), 0.5f * a, 2e-6f) << preset.name << " " << x << "," << y;
        ASSERT_NEAR(out["B"].at(x, y), 2.0f * a, 4e-6f) << preset.name << " " << x << "," << y;
        partly += a > 0.02f && a < 0.98f;
      }
      EXPECT_TRUE(y <= 10 || y >= 22 || partly > 0) << preset.name << " row " << y;
    }
  }
}

TEST_F(Acceptance, T15_EveryWayToWriteDepthGivesTheSameMasks) {
  // A thing moves before a background that is infinitely far; all distances are powers of two, so that one over them is
  // exact.
  const glm::dvec2 v(1.3, 0.4);
  const auto scene = [&](float background, bool inverse) -> World {
    return [=](glm::dvec2 at, int f) {
      const glm::dvec2 p = at - v * double(f);
      const bool thing = std::fmod(p.x + 800, 14) < 5 && std::fmod(p.y + 800, 11) < 6;
      Seen s;
      s.color = texture(p) * float(0.9 + 0.2 * chance(unsigned(at.x), unsigned(at.y), unsigned(f)));
      s.depth = thing ? 4.0f : background;
      if (thing && inverse) s.depth = 0.25f;
      s.id = thing ? 2u : 1u;
      if (thing) s.back = -v, s.on = v;
      return s;
    };
  };
  struct Encoding {
    const char* name;
    float background;
    const char* kind;
  };
  const std::vector<Encoding> encodings = {{"inf", INFINITY, "distance"},
                                           {"1e10", 1e10f, "distance"},
                                           {"zero", 0.0f, "distance"},
                                           {"nan", std::nanf(""), "distance"},
                                           {"reversed", 0.0f, "inverse"}};
  for (const Encoding& e : encodings)
    write(e.name, scene(e.background, std::string(e.kind) == "inverse"), 1, 5, {.data = {0, 0, 48, 32}});
  for (const Preset& preset : presets()) {
    Arguments line = {"-p", std::string(preset.name), "--disocclusion", "depth", "--keep", "none"};
    const Accumulator accumulator = preset_parameters(preset).accumulator;
    line = line + Arguments{"--aov", accumulator == Accumulator::gather ? "surfaces,frames" : "reject,motion"};
    for (const Encoding& e : encodings)
      resolve_well(e.name, std::string("out-") + e.name, line + Arguments{"--depth-kind", e.kind});
    for (int f = 2; f <= 5; ++f) {
      const ReadFile first = read("out-inf", f);
      for (const Encoding& e : encodings) {
        const ReadFile other = read(std::string("out-") + e.name, f);
        for (const auto& [channel, plane] : first.channels)
          each_pixel(first.data, [&](int x, int y) {
            ASSERT_EQ(plane.at(x, y), other[channel].at(x, y))
                << preset.name << " " << e.name << " " << channel << " " << x << "," << y;
          });
      }
    }
  }
}

TEST_F(Acceptance, T16_ShiftedAndOverscannedWindowsGiveTheSameInterior) {
  const Window display{0, 0, 96, 72};
  const auto write_with = [&](const std::string& name, auto window) {
    std::filesystem::create_directories(folder / name);
    for (int f = 1; f <= 5; ++f) {
      FileOptions options;
      options.display = display;
      options.data = window(f);
      write_frame_file(folder / (name + "/in." + frame_number(f) + ".exr"), frame_of(moving, f, options));
    }
  };
  write_with("plain", [&](int) { return display; });
  write_with("overscan", [&](int) { return Window{-13, -7, 96 + 11, 72 + 5}; });
  write_with("shifting", [&](int f) { return Window{-3 * f, f - 4, 96 + 2 * f, 72 + 9 - f}; });
  for (const Preset& preset : presets()) {
    const Parameters parameters = preset_parameters(preset);
    for (const char* in : {"plain", "overscan", "shifting"})
      resolve_well(in, std::string("out-") + in, {"-p", std::string(preset.name), "--keep", "none"});
    // What a window's edge can reach in five frames: windows of the box and filters, or the windows of light.
    const bool gain = parameters.accumulator == Accumulator::gather && parameters.gather.gain;
    const Window inside = inside_of(display, gain ? parameters.gather.gain_window + 8 : 20);
    // The gather counts its tiles from the window's corner, and adds up in their order: the same to a few steps of
    // float.
    const double slack = parameters.accumulator == Accumulator::gather ? 4e-6 : 0;
    for (int f = 1; f <= 5; ++f) {
      const ReadFile plain = read("out-plain", f);
      for (const char* in : {"overscan", "shifting"}) {
        const ReadFile other = read(std::string("out-") + in, f);
        double worst = 0;
        each_pixel(inside, [&](int x, int y) {
          for (const char* c : {"R", "G", "B", "A"}) {
            const double one = double(plain[c].at(x, y));
            worst = std::max(worst, std::fabs(double(other[c].at(x, y)) - one) / std::fabs(one));
          }
        });
        EXPECT_LE(worst, slack) << preset.name << " " << in << " frame " << f;
      }
    }
  }
}

TEST_F(Acceptance, T17_ThreadsAndChunksChangeNoByte) {
  write("in", moving, 1, 9, {.data = {0, 0, 45, 27}});
  for (const Preset& preset : presets()) {
    const Arguments line = {"-p", std::string(preset.name), "--aov", "count,reject,motion"};
    for (const char* threads : {"1", "2", "8"})
      resolve_well("in", std::string("out-") + threads, line + Arguments{"--threads", threads});
    for (const char* threads : {"2", "8"})
      for (int f = 1; f <= 9; ++f)
        EXPECT_TRUE(bytes("out-1", f) == bytes(std::string("out-") + threads, f)) << preset.name << f;
    // Recursion goes back to the first frame: a chunk of it is warmed up by all of them.
    // Its header says so, its pixels are the same.
    const bool ahead = looks_ahead(preset);
    const Arguments all = ahead ? Arguments{} : Arguments{"--preroll", "9"};
    resolve_well("in", "chunk", line + all + Arguments{"-f", "4-6", "--threads", "2"});
    for (int f = 4; f <= 6; ++f) {
      EXPECT_TRUE(!ahead || bytes("out-1", f) == bytes("chunk", f)) << preset.name << f;
      const ReadFile whole = read("out-1", f), chunk = read("chunk", f);
      for (const auto& [name, plane] : whole.channels)
        each_pixel(whole.data, [&](int x, int y) {
          ASSERT_TRUE(plane.at(x, y) == chunk[name].at(x, y)) << preset.name << " " << name;
        });
    }
  }
}

TEST_F(Acceptance, T18_LongVectorsInHalfAreTold) {
  const glm::dvec2 v(600, 0);
  const FileOptions options{.data = {0, 0, 64, 16}};
  std::filesystem::create_directories(folder / "in");
  for (int f = 1; f <= 3; ++f) {
    FrameFile frame = frame_of([&](glm::dvec2 at, int) { return Seen{texture(at), 1, 8, -v, v}; }, f, options);
    frame.half = {"velocity.x", "velocity.y"};
    write_frame_file(folder / ("in/in." + frame_number(f) + ".exr"), frame);
  }
  const Outcome outcome = run_varve({"resolve", "in/in.####.exr", "-o", "o.####.exr", "-p", "salvi"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("half"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("velocity.x"), std::string::npos) << outcome.err;
  const Outcome probe = run_varve({"probe", "in/in.####.exr"}, folder.path());
  EXPECT_NE(probe.out.find("are stored as half"), std::string::npos) << probe.out;
}

TEST_F(Acceptance, T19_FirstAndLastFramesExistAndLookOneWay) {
  write("in", moving, 3, 9, {.data = {0, 0, 32, 20}});
  for (const Preset& preset : presets()) {
    const bool ahead = looks_ahead(preset);
    resolve_well("in", "out",
                 {"-p", std::string(preset.name), "--aov", ahead ? "count,count-past,count-future" : "count"});
    const ReadFile first = read("out", 3), middle = read("out", 6), last = read("out", 9);
    each_pixel(inside_of(first.data, 8), [&](int x, int y) {
      for (const ReadFile* file : {&first, &middle, &last}) ASSERT_TRUE(std::isfinite((*file)["R"].at(x, y)));
      ASSERT_GE(first["varve.count"].at(x, y), 1.0f) << preset.name;
      ASSERT_GT(last["varve.count"].at(x, y), 1.0f) << preset.name;
      if (!ahead) return;
      ASSERT_EQ(first["varve.count-past"].at(x, y), 0.0f) << preset.name;
      ASSERT_EQ(last["varve.count-future"].at(x, y), 0.0f) << preset.name;
      ASSERT_GT(first["varve.count-future"].at(x, y), 0.0f) << preset.name;
      ASSERT_GT(last["varve.count-past"].at(x, y), 0.0f) << preset.name;
      ASSERT_GT(middle["varve.count-past"].at(x, y), 0.0f) << preset.name;
      ASSERT_GT(middle["varve.count-future"].at(x, y), 0.0f) << preset.name;
    });
  }
}

TEST_F(Acceptance, T20_MissingAndDoubledNumbersAreNoSilentNeighbors) {
  // Red before the gap, green after it: nothing of one may show in the other.
  const auto shot = [](glm::dvec2 at, int f) {
    const float value = float(0.5 + chance(unsigned(at.x), unsigned(at.y), unsigned(f)));
    return f < 5 ? Seen{{value, 0, 0, 1}, 1, 8, {}, {}} : Seen{{0, value, 0, 1}, 1, 8, {}, {}};
  };
  write("in", shot, 1, 9, {.data = {0, 0, 20, 12}});
  std::filesystem::remove(folder / "in/in.0005.exr");
  for (const Preset& preset : presets()) {
    std::filesystem::remove_all(folder / "out");
    const Outcome outcome = resolve("in", "out", {"-p", std::string(preset.name)});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("gap after frame 4"), std::string::npos) << preset.name << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out/o.0005.exr")) << "no frame is made up";
    const ReadFile before = read("out", 4), after = read("out", 6);
    each_pixel(before.data, [&](int x, int y) {
      ASSERT_EQ(before["G"].at(x, y), 0.0f) << preset.name;
      ASSERT_EQ(after["R"].at(x, y), 0.0f) << preset.name;
    });
  }
  // A number that is asked for and is not there.
  const Outcome missing = resolve("in", "out", {"-f", "4-6"});
  EXPECT_EQ(missing.code, 3) << missing.err;
  EXPECT_NE(missing.err.find("0005"), std::string::npos) << missing.err;
  // The same number in another spelling is another file, never a second frame 3.
  std::filesystem::copy_file(folder / "in/in.0008.exr", folder / "in/in.00003.exr");
  resolve_well("in", "whole", {"-p", "standard", "-f", "1-4"});
  const ReadFile third = read("whole", 3);
  each_pixel(third.data, [&](int x, int y) { ASSERT_EQ(third["G"].at(x, y), 0.0f); });
  // A frame asked for twice is made once; a doubled frame (same file under the next number) counts once.
  const Outcome twice = resolve("in", "twice", {"-f", "2,2,1-3"});
  EXPECT_EQ(twice.code, 0) << twice.err;
  EXPECT_EQ(files_below(folder / "twice").size(), 3u);
  std::filesystem::copy_file(folder / "in/in.0007.exr", folder / "in/in.0008.exr",
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome doubled = resolve("in", "doubled", {"-p", "draft", "-f", "6-9", "--find-cuts", "on"});
  EXPECT_EQ(doubled.code, 0) << doubled.err;
  EXPECT_NE(doubled.err.find("frame 8"), std::string::npos) << doubled.err;
}

}  // namespace
}  // namespace varve::test
