// T01 to T06: what must come out exactly, or to a stated figure.
#include <bit>
#include <cmath>

#include "acceptance.h"
#include "resolve/accumulate.h"
#include "support/scenes.h"

namespace varve::test {
namespace {

/// Steps of float between two numbers of one sign.
long ulps(float a, float b) { return std::labs(long(std::bit_cast<int>(a)) - long(std::bit_cast<int>(b))); }

// Five-tap filters that are not normalized, negative weights, and curves there and back fail this one.
TEST_F(Acceptance, T01_ConstantImageWithAnyVectorsStaysToOneStepOfTheFormat) {
  for (const bool half : {false, true}) {
    const glm::vec4 color = half ? glm::vec4(0.1f, 3.7f, 65504.0f, 0.3f) : glm::vec4(0.1f, 3.7f, 1e6f, 0.3f);
    const std::string in = half ? "half" : "float";
    const auto any = [](glm::dvec2 at, int frame, unsigned salt) {
      return 12 * chance(unsigned(at.x * 8), unsigned(at.y * 8), unsigned(frame), salt) - 6;
    };
    write(in,
          [&](glm::dvec2 at, int f) {
            return Seen{color, 1, 10, {any(at, f, 1), any(at, f, 2)}, {any(at, f, 3), any(at, f, 4)}};
          },
          1, 5, {.half = half});
    for (const Arguments& preset : all_presets()) {
      resolve_well(in, "out", preset);
      for (int frame = 1; frame <= 5; ++frame) {
        const ReadFile given = read_frame_file(folder / (in + "/in." + frame_number(frame) + ".exr"));
        const ReadFile out = read("out", frame);
        each_pixel(out.data, [&](int x, int y) {
          for (const char* channel : {"R", "G", "B", "A"}) {
            const float a = given[channel].at(x, y), b = out[channel].at(x, y);
            ASSERT_LE(ulps(a, b), half ? 0 : 1) << preset[1] << " " << frame << " " << channel << " " << x << "," << y;
          }
        });
      }
    }
  }
}

// A ramp that moves by fractions of pixels: first-order exact filters keep it.
TEST_F(Acceptance, T02_RampUnderConstantMotionStaysAndBilinearBlursByYangsVariance) {
  const glm::dvec2 v(0.3, -0.2);
  const World ramp = [&](glm::dvec2 at, int f) {
    const glm::dvec2 p = at - v * double(f);
    const float value = float(10 + 0.05 * p.x + 0.03 * p.y);
    return Seen{{value, value, value, 1}, 1, 10, -v, v};
  };
  const auto worst_of = [&](const std::string& to, int frame) {
    const ReadFile out = read(to, frame);
    double worst = 0;
    each_pixel(inside_of(out.data, 22), [&](int x, int y) {
      const double truth = 10 + 0.05 * (x + 0.5 - v.x * frame) + 0.03 * (y + 0.5 - v.y * frame);
      worst = std::max(worst, std::fabs(double(out["R"].at(x, y)) - truth));
    });
    return worst;
  };
  write("ramp", ramp, 1, 12, {.data = {0, 0, 64, 56}, .jitter = false});
  const double ulp = 9.5367e-7;  // of floats from 8 to 16
  for (const char* const filter : {"bilinear", "catmull-rom", "catmull-rom9", "cubic", "bspline3", "bspline5"}) {
    resolve_well("ramp", "out", {"-p", "salvi", "--box", "none", "--history-filter", filter});
    EXPECT_LE(worst_of("out", 12), 6 * ulp) << filter;  // every one of 12 frames rounds once
  }
  // The gather averages samples near each cell's middle, which needs them on both sides of it. Where they lie evenly,
  // at rest and with jitter, the ramp stays; a steady motion brings them along a line, and what is stated is what was
  // measured: up to .06 of a pixel's step of the ramp (.08).
  for (const char* const preset : {"draft", "standard", "high", "reference"}) {
    resolve_well("ramp", "out", {"-p", preset, "--gain", "off"});
    EXPECT_LE(worst_of("out", 6), 0.12 * 0.08) << preset;
  }

  // A bump through bilinear history at half a pixel a frame: variance (1 - a) / a * v (1 - v) an axis more.
  const glm::dvec2 half(0.5, 0);
  write("bump",
        [&](glm::dvec2 at, int f) {
          const double d = (at - half * double(f)).x - 20;
          const float value = float(std::exp(-d * d / (2 * 3.0 * 3.0)));
          return Seen{{value, value, value, 1}, 1, 10, -half, half};
        },
        1, 80, {.data = {0, 0, 120, 5}, .jitter = false});
  for (const auto& [alpha, excess] : {std::pair{"0.1", 2.25}, {"0.2", 1.0}}) {
    resolve_well("bump", "out",
                 {"-p", "salvi", "--box", "none", "--history-filter", "bilinear", "--alpha", alpha, "--alpha-rule",
                  "fixed", "-f", "1-80"});
    const ReadFile out = read("out", 80);
    double n = 0, sum = 0, squares = 0;
    for (int x = 10; x < 110; ++x) {
      const double value = double(out["R"].at(x, 2));
      n += value, sum += value * x, squares += value * x * x;
    }
    EXPECT_NEAR(squares / n - sum * sum / (n * n) - 9, excess, 0.01 * excess) << alpha;
  }
}

// Weighing by luminance gives .89 here.
TEST_F(Acceptance, T03_HalfCoveredEdgeOf16OverNothingIs8) {
  const int frames = 64;
  const FileOptions options{.data = {0, 0, 17, 3}, .jitter_period = frames};
  for (const bool turned : {false, true})
    write(
        turned ? "turned" : "edge",
        [&](glm::dvec2 at, int) {
          const float value = (at.x < 8.5) != turned ? 16.0f : 0.0f;
          return Seen{{value, value, value, 1}, 1, 10, {}, {}};
        },
        1, frames, options);
  const auto edge = [&](const std::string& in, const char* frames_to_write, int frame, const Arguments& choices) {
    resolve_well(in, "out", choices + Arguments{"-f", frames_to_write});
    return double(read("out", frame)["R"].at(8, 1));
  };
  const Arguments mean = {"-p", "salvi", "--box", "none", "--alpha", "0.001"};
  EXPECT_NEAR(edge("edge", "1-64", frames, mean), 8, 0.08);
  EXPECT_NEAR(edge("edge", "1-64", frames, mean + Arguments{"--weighing", "luminance"}), 0.89, 0.03)
      << "what weighing by luminance is documented to do";
  const Arguments sides = {"-p",      "two-sided", "--box",        "none", "--clip-discount", "off",
                           "--alpha", "0.001",     "--alpha-rule", "mean", "--look-ahead",    "64"};
  EXPECT_NEAR(edge("edge", "32", 32, sides), 8, 0.08) << "two-sided";
  // The gather weighs samples by the area around them: with 64 of them an edge stands within .01 px of its place, which
  // is 2 % of this pixel (measured: 7.88 to 7.89). Light is neither lost nor won: lit from the other side the same edge
  // is as much brighter, and the mean of both is 8.
  for (const char* preset : {"standard", "high", "reference"}) {
    const Arguments gather = {"-p", preset, "--reach", "64"};
    const double one = edge("edge", "32", 32, gather), other = edge("turned", "32", 32, gather);
    EXPECT_NEAR(one, 8, 0.16) << preset;
    EXPECT_NEAR((one + other) / 2, 8, 0.0008) << preset;
  }
}

// A bad sample is told, and reaches no farther than a filter does.
TEST_F(Acceptance, T04_BadSamplesStayWithinTheFiltersAndAreCounted) {
  const FileOptions options{.data = {0, 0, 160, 28}};
  const World world = [](glm::dvec2 at, int f) {
    glm::vec4 c = texture(at);
    c *= float(0.9 + 0.2 * chance(unsigned(at.x), unsigned(at.y), unsigned(f)));
    return Seen{c, 1, 10, {}, {}};
  };
  write("clean", world, 1, 5, options);
  write("bad", world, 1, 5, options);
  FrameFile bad = frame_of(world, 3, options);
  bad.channels["R"].at(20, 14) = std::nanf("");
  bad.channels["G"].at(60, 14) = INFINITY;
  bad.channels["B"].at(100, 14) = -1;
  bad.channels["R"].at(140, 14) = 1e30f;
  write_frame_file(folder / "bad/in.0003.exr", bad);
  for (const Preset& preset : presets()) {
    const Arguments line = {"-p", std::string(preset.name), "--aov", "reject,repaired"};
    resolve_well("clean", "good", line);
    resolve_well("bad", "hurt", line + Arguments{"--report", (folder / "report.json").string()});
    const Parameters parameters = preset_parameters(preset);
    // A recursive pixel sees its window, and what stands in for a bad sample its neighbors. A gathered one sees the
    // light of the surface around, once for the pilot and once for the comparison with it.
    const bool gain = parameters.accumulator == Accumulator::gather && parameters.gather.gain;
    // Four histories look at the residual around, and read each other, once more in every frame.
    const bool four = parameters.accumulator == Accumulator::subpixel;
    const int support = gain   ? parameters.gather.gain_window + 4
                        : four ? 3 * (parameters.recursive.residual_window / 2 + 1) + 4
                               : 4;
    for (int frame = 1; frame <= 5; ++frame) {
      const ReadFile a = read("good", frame), b = read("hurt", frame);
      each_pixel(a.data, [&](int x, int y) {
        bool near = false;
        for (const int at : {20, 60, 100, 140})
          near = near || (std::abs(x - at) <= support && std::abs(y - 14) <= support);
        for (const char* channel : {"R", "G", "B", "A"}) {
          ASSERT_TRUE(std::isfinite(b[channel].at(x, y))) << preset.name << frame << " " << x << "," << y;
          if (near) continue;
          ASSERT_EQ(a[channel].at(x, y), b[channel].at(x, y)) << preset.name << " " << frame << " " << x << "," << y;
        }
        const bool broken = frame == 3 && y == 14 && (x == 20 || x == 60);
        ASSERT_EQ(b["varve.repaired"].at(x, y), broken ? 1.0f : 0.0f) << preset.name << " " << x << "," << y;
      });
    }
    const std::string report = bytes_of(folder / "report.json");
    EXPECT_NE(report.find("\"not_finite\":2"), std::string::npos) << preset.name << report;
  }
}

// No deviation must not become a deviation of rounding, nor 0 / 0.
TEST_F(Acceptance, T05_FlatPatchOf1000HasNoBoxOfItsOwn) {
  const float above = std::nextafter(1000.0f, 2000.0f);
  write("flat",
        [&](glm::dvec2, int f) {
          return Seen{glm::vec4(f % 2 ? 1000.0f : above), 1, 10, {}, {}};
        },
        1, 8, {.data = {0, 0, 15, 9}, .jitter = true});
  write("same",
        [](glm::dvec2, int) {
          return Seen{glm::vec4(1000.0f), 1, 10, {}, {}};
        },
        1, 8, {.data = {0, 0, 15, 9}, .jitter = true});
  for (const Preset& preset : presets()) {
    const bool clips = preset_parameters(preset).accumulator != Accumulator::gather;
    for (const char* const in : {"same", "flat"}) {
      resolve_well(in, "out", {"-p", std::string(preset.name), "--aov", clips ? "clip,count" : "count"});
      for (const int frame : {1, 4, 8}) {
        const ReadFile out = read("out", frame);
        each_pixel(out.data, [&](int x, int y) {
          const float value = out["G"].at(x, y);
          ASSERT_TRUE(value >= 1000.0f && value <= (std::string(in) == "same" ? 1000.0f : above))
              << preset.name << " " << value;
          ASSERT_TRUE(std::isfinite(out["varve.count"].at(x, y)));
          const float clip = clips ? out["varve.clip"].at(x, y) : 0.0f;
          ASSERT_EQ(clip, 0.0f) << preset.name << " " << in << " frame " << frame;
        });
      }
    }
  }
}

// 100 000 files would take minutes: this one goes through the accumulator itself.
TEST_F(Acceptance, T06_ALongMeanAtRestIsTheMean) {
  Workers workers(1);
  const Window w{0, 0, 4, 1};
  RecursiveParameters recursive;
  recursive.alpha = 1e-6;
  RectifyParameters rectify;
  rectify.box = Box::none;
  const int frames = 100000;
  std::vector<double> sum(16, 0.0);
  Present present = flat_present(w, glm::vec4(0), workers);
  History history;
  for (int f = 0; f < frames; ++f) {
    for (int x = 0; x < 4; ++x)
      for (int k = 0; k < 4; ++k) {
        const float value = float((k + 1) * 10 * chance(unsigned(x), unsigned(k), unsigned(f)));
        present.color.at(x, 0)[k] = value;
        sum[std::size_t(4 * x + k)] += double(value);
      }
    history = accumulate(present, history, recursive, rectify, {}, 1, {}, workers).history;
  }
  double worst = 0;
  for (int x = 0; x < 4; ++x)
    for (int k = 0; k < 4; ++k) {
      const double mean = sum[std::size_t(4 * x + k)] / frames;
      worst = std::max(worst, std::fabs(double(history.color.at(x, 0)[k]) - mean) / mean);
    }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LE(worst, 1e-6);
}

}  // namespace
}  // namespace varve::test
