// Every preset and every accumulator, from files to files, over hostile sequences. The tables of the program are walked
// through: what is added to them is tested without a line here.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "plan/knob_words.h"
#include "plan/preset.h"
#include "resolve_sequence.h"
#include "stability/shots.h"
#include "stages/preflight.h"
#include "support/frame_file.h"

namespace varve::stability {
namespace {

namespace fs = std::filesystem;
using test::ReadFile;

struct Recipe {
  std::string name;
  Parameters parameters;
};

/// Presets as they are, and each accumulator with what is default besides.
std::vector<Recipe> recipes() {
  std::vector<Recipe> all;
  for (const Preset& preset : presets()) all.push_back({std::string(preset.name), preset_parameters(preset)});
  for (const Word<Accumulator>& accumulator : kAccumulators) {
    Parameters p;
    p.accumulator = accumulator.value;
    all.push_back({"accumulator " + std::string(accumulator.word), p});
  }
  return all;
}

class Presets : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("varve-stability-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const RawShot& shot) const {
    fs::create_directories(folder_ / name);
    for (std::size_t f = 0; f < shot.size(); ++f) {
      const RawFrame& raw = shot[f];
      test::FrameFile file;
      file.data = file.display = raw.window();
      file.jitter = raw.jitter;
      const auto add = [&](const char* channel, const auto& value) {
        Plane<float>& plane = file.channels[channel] = Plane<float>(raw.window());
        for (int y = raw.window().y0; y < raw.window().y1; ++y)
          for (int x = raw.window().x0; x < raw.window().x1; ++x) plane.at(x, y) = value(x, y);
      };
      const char* const names[] = {"R", "G", "B", "A"};
      for (int k = 0; k < 4; ++k) add(names[k], [&](int x, int y) { return raw.color.at(x, y)[k]; });
      add("Z", [&](int x, int y) { return raw.depth.at(x, y); });
      add("velocity.x", [&](int x, int y) { return raw.backward.at(x, y).x; });
      add("velocity.y", [&](int x, int y) { return raw.backward.at(x, y).y; });
      add("forward.x", [&](int x, int y) { return raw.forward.at(x, y).x; });
      add("forward.y", [&](int x, int y) { return raw.forward.at(x, y).y; });
      file.ids["id"] = raw.id.clone();
      test::write_frame_file(folder_ / name / ("in." + test::frame_number(int(f) + 1) + ".exr"), file);
    }
  }

  ResolveJob job(const Recipe& recipe, const std::string& from, const std::string& to, int threads) const {
    fs::create_directories(folder_ / to);
    ResolveJob job;
    job.input.color = SequencePattern::parse((folder_ / from / "in.####.exr").string());
    job.output = SequencePattern::parse((folder_ / to / "o.####.exr").string());
    job.parameters = recipe.parameters;
    job.check_motion = false;  // vectors are meant to be wrong here
    job.threads = threads;
    return job;
  }
  std::string bytes(const std::string& to, int frame) const {
    std::ostringstream all;
    all << std::ifstream(path(to, frame), std::ios::binary).rdbuf();
    return all.str();
  }
  std::string path(const std::string& to, int frame) const {
    return folder_ / to / ("o." + test::frame_number(frame) + ".exr");
  }
  ReadFile read(const std::string& to, int frame) const { return test::read_frame_file(path(to, frame)); }

  /// Color of every frame is there and finite.
  void expect_finite(const std::string& what, const std::string& to, int frames) const {
    for (int f = 1; f <= frames; ++f) {
      const ReadFile out = read(to, f);
      for (const char* channel : {"R", "G", "B", "A"})
        for (int y = out.data.y0; y < out.data.y1; ++y)
          for (int x = out.data.x0; x < out.data.x1; ++x)
            ASSERT_TRUE(std::isfinite(out[channel].at(x, y)))
                << what << " frame " << f << " " << channel << " " << x << "," << y;
    }
  }

 private:
  fs::path folder_;
};

TEST_F(Presets, AreFiniteOverEveryExtreme) {
  const Window odd{-5, -9, 12, 4};
  for (const Extreme& extreme : extremes()) {
    const RawShot shot = extreme.make(odd);
    write("in", shot);
    for (const Recipe& recipe : recipes()) {
      const ResolveSummary done = resolve_sequence(job(recipe, "in", "out", 1), {});
      EXPECT_EQ(done.frames_written, 3) << recipe.name;
      expect_finite(recipe.name + ", " + extreme.name, "out", 3);
    }
  }
}

TEST_F(Presets, TakeEverySize) {
  std::vector<Window> windows = awkward_windows(false);
  windows.push_back({0, 0, 16384, 1});
  for (const Window& window : windows) {
    if (window.empty()) continue;  // a file has a pixel at least
    write("in", base_shot(window, Moves::any, 2, 60));
    for (const Recipe& recipe : recipes()) {
      EXPECT_EQ(resolve_sequence(job(recipe, "in", "out", 2), {}).frames_written, 2) << recipe.name;
      expect_finite(recipe.name + " " + std::to_string(window.width()) + " wide", "out", 2);
    }
  }
}

TEST_F(Presets, ScaleWithTheLight) {
  const RawShot plain = base_shot({0, 0, 22, 17}, Moves::any, 4, 61);
  write("plain", plain);
  write("scaled", scaled(plain, 1048576.0f));
  for (const Recipe& recipe : recipes()) {
    // Weighing by brightness knows what is bright, unless told so.
    if (recipe.parameters.recursive.weight.weighing != Weighing::none) continue;
    resolve_sequence(job(recipe, "plain", "one", 1), {});
    resolve_sequence(job(recipe, "scaled", "other", 1), {});
    for (int f = 1; f <= 4; ++f) {
      const ReadFile a = read("one", f), b = read("other", f);
      for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 22; ++x) {
          for (const char* channel : {"R", "G", "B"})
            ASSERT_EQ(a[channel].at(x, y) * 1048576.0f, b[channel].at(x, y)) << recipe.name << " " << x << "," << y;
          ASSERT_EQ(a["A"].at(x, y), b["A"].at(x, y)) << recipe.name;
        }
    }
  }
}

TEST_F(Presets, AMirrorChangesNothingButTheSides) {
  // A multiple of the tiles that the gather counts from the corner.
  const RawShot plain = base_shot({0, 0, 32, 32}, Moves::pan, 3, 62);
  write("plain", plain);
  for (const bool vertical : {false, true}) {
    write("mirror", mirrored(plain, vertical));
    for (const Recipe& recipe : recipes()) {
      resolve_sequence(job(recipe, "plain", "one", 1), {});
      resolve_sequence(job(recipe, "mirror", "other", 1), {});
      int apart = 0;
      for (int f = 1; f <= 3; ++f) {
        const ReadFile a = read("one", f), b = read("other", f);
        for (int y = 0; y < 32; ++y)
          for (int x = 0; x < 32; ++x) {
            const float u = a["G"].at(x, y), v = b["G"].at(vertical ? x : 31 - x, vertical ? 31 - y : y);
            apart += !(std::abs(u - v) <= 1e-4f * std::max(std::abs(u), 1e-3f));
          }
      }
      EXPECT_LE(apart, 3 * 1024 / 50) << recipe.name << (vertical ? ", rows" : ", columns");
    }
  }
}

TEST_F(Presets, ThreadsAndChunksChangeNoByte) {
  write("in", base_shot({0, 0, 41, 23}, Moves::any, 7, 63));
  for (const Recipe& recipe : recipes()) {
    resolve_sequence(job(recipe, "in", "one", 1), {});
    for (const int threads : {2, 5}) {
      resolve_sequence(job(recipe, "in", "many", threads), {});
      for (int f = 1; f <= 7; ++f) EXPECT_TRUE(bytes("one", f) == bytes("many", f)) << recipe.name << " " << threads;
    }
    ResolveJob chunk = job(recipe, "in", "chunk", 2);
    if (reach_of(chunk).back_to_restart) continue;  // recursion goes back as far as there is history
    chunk.frames = {3, 4};
    resolve_sequence(chunk, {});
    for (const int f : {3, 4}) EXPECT_TRUE(bytes("one", f) == bytes("chunk", f)) << recipe.name << " " << f;
  }
}

TEST_F(Presets, AlphaOfZeroIsRefused) {
  Parameters p;
  for (const char* text : {"alpha=0", "alpha=-1", "alpha=nan", "alpha=inf", "gamma=-1", "gamma=inf", "window=2",
                           "window=65", "sigma=0", "cells=0", "cells=9", "reach=-1", "reject-alpha=0"})
    EXPECT_THROW(set_parameters(p, text), Failure) << text;
  for (const char* text : {"alpha=1e-6", "alpha=1", "gamma=0", "gamma=100", "window=63", "reach=256"})
    EXPECT_NO_THROW(set_parameters(p, text)) << text;
}

}  // namespace
}  // namespace varve::stability
