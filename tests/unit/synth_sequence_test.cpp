// Files from nothing, and the sequences that are made of them.
#include "synth_sequence.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "exr/convert.h"
#include "exr/jitter.h"
#include "exr/new_file.h"
#include "exr/read_frame.h"
#include "synth/moment.h"
#include "synth/scenes.h"

namespace varve {
namespace {

namespace fs = std::filesystem;

class SynthSequence : public testing::Test {
 protected:
  SynthSequence() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::temp_directory_path() / ("varve_" + std::to_string(::getpid()) + "_" + test->name());
    fs::create_directories(folder);
    job.folder = folder.string();
    job.frames = {3};
    job.width = 64;
    job.height = 36;
  }
  ~SynthSequence() override { fs::remove_all(folder); }

  std::string path(const std::string& below) const { return (folder / below).string(); }
  static std::string bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  std::vector<float> channel(const FileHeader& header, int part, const std::string& name) {
    const ChannelRef ref{0, part, header.parts[std::size_t(part)].channel(name).value()};
    const FramePixels pixels = read_channels(header, {&ref, 1}, workers);
    const RawPlane& plane = pixels[ref];
    std::vector<float> values(std::size_t(plane.rows) * std::size_t(plane.columns));
    for (int y = 0; y < plane.rows; ++y)
      to_float(plane.type, plane.row(y), values.data() + y * plane.columns, std::size_t(plane.columns));
    return values;
  }

  fs::path folder;
  SynthJob job;
  Workers workers;
};

TEST_F(SynthSequence, JitterIsTheSameInHeaderTableAndSample) {
  job.scene = "quality-all";
  job.frames = {2, 5, 19};
  job.type = PixelType::float32;
  EXPECT_EQ(synth_sequence(job, {}), 3);
  const JitterSource table = parse_jitter_source(path("jitter.csv")), halton = parse_jitter_source("halton23:16");
  const synth::Scene scene = synth::make_scene(job.scene);
  for (const int frame : job.frames) {
    char name[32];
    std::snprintf(name, sizeof name, "quality-all.%04d.exr", frame);
    const FileHeader header = read_header(path(name));
    ASSERT_EQ(header.parts.size(), 1u);
    const Jitter said = jitter_of({}, header.parts[0], frame).value();
    const Jitter listed = jitter_of(table, header.parts[0], frame).value();
    const Jitter wanted = jitter_of(halton, header.parts[0], frame).value();
    EXPECT_EQ(said.x, listed.x);
    EXPECT_EQ(said.y, listed.y);
    EXPECT_EQ(said.x, double(float(wanted.x)));
    EXPECT_EQ(said.y, double(float(wanted.y)));
    const synth::Moment moment = synth::moment_of(scene, frame, job.width, job.height);
    const std::vector<float> red = channel(header, 0, "R"), z = channel(header, 0, "Z"),
                             bx = channel(header, 0, "velocity.x"), fy = channel(header, 0, "forward.y"),
                             id = channel(header, 0, "id");
    for (int y = 0; y < job.height; ++y)
      for (int x = 0; x < job.width; ++x) {
        const synth::Sample sample = synth::evaluate(moment, x + 0.5 + said.x, y + 0.5 + said.y);
        const std::size_t i = std::size_t(y * job.width + x);
        ASSERT_EQ(red[i], float(sample.color.r));
        ASSERT_EQ(z[i], float(sample.depth));
        ASSERT_EQ(bx[i], float(sample.backward.x));
        ASSERT_EQ(fy[i], float(sample.forward.y));
        ASSERT_EQ(id[i], float(sample.id));
      }
  }
}

TEST_F(SynthSequence, SamplesHavePartsAndJittersOfTheirOwn) {
  job.scene = "pan";
  job.samples = 4;
  job.frames = {1, 3, 17};
  synth_sequence(job, {});
  const FileHeader header = read_header(path("pan.0003.exr"));
  ASSERT_EQ(header.parts.size(), 4u);
  for (int s = 0; s < 4; ++s) {
    const Part& part = header.parts[std::size_t(s)];
    EXPECT_EQ(part.name, "sample." + std::to_string(s));
    // Point 4 (f - 1) + s + 1 of Halton (2,3).
    const Jitter wanted = jitter_of(parse_jitter_source("halton23:64"), part, 4 * 2 + s + 1).value();
    const Jitter said = jitter_of({}, part, 3).value();
    EXPECT_EQ(said.x, double(float(wanted.x)));
    EXPECT_EQ(said.y, double(float(wanted.y)));
  }
  const std::string table = bytes(path("jitter.csv"));
  EXPECT_TRUE(table.starts_with("frame,sample,jx,jy\n1,0,")) << table;
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 13);
  const auto first = bytes(path("pan.0001.exr")), again = bytes(path("pan.0017.exr"));
  EXPECT_EQ(jitter_of({}, read_header(path("pan.0001.exr")).parts[2], 1)->x,
            jitter_of({}, read_header(path("pan.0017.exr")).parts[2], 17)->x);
  EXPECT_NE(first, again);
}

TEST_F(SynthSequence, SameBytesForAnyNumberOfThreads) {
  job.scene = "stochastic-alpha";
  job.noise = 0.3;
  job.truth = synth::Filter::gaussian;
  job.truth_samples = 9;
  job.yardsticks = {2};
  std::string before;
  for (const int threads : {1, 2, 5}) {
    job.threads = threads;
    synth_sequence(job, {});
    std::string all;
    for (const char* below : {"stochastic-alpha.0003.exr", "truth/stochastic-alpha.0003.exr",
                              "ss2/stochastic-alpha.0003.exr", "jitter.csv"}) {
      ASSERT_FALSE(bytes(path(below)).empty()) << below;
      all += bytes(path(below));
    }
    if (before.empty()) before = all;
    EXPECT_EQ(all, before) << threads;
  }
  job.seed = 2;
  synth_sequence(job, {});
  EXPECT_EQ(before.find(bytes(path("stochastic-alpha.0003.exr"))), std::string::npos) << "the seed changes nothing";
}

TEST_F(SynthSequence, LayersAreWrittenBesideTheComposite) {
  job.scene = "panes";
  job.layers = true;
  job.type = PixelType::float32;
  synth_sequence(job, {});
  const FileHeader header = read_header(path("panes.0003.exr"));
  for (const std::string base : {"R", "A"}) {
    const std::vector<float> whole = channel(header, 0, base), fg = channel(header, 0, "fg." + base),
                             mid = channel(header, 0, "mid." + base), bg = channel(header, 0, "bg." + base),
                             fa = channel(header, 0, "fg.A"), ma = channel(header, 0, "mid.A");
    for (std::size_t i = 0; i < whole.size(); ++i)
      ASSERT_NEAR(whole[i], fg[i] + (1 - fa[i]) * (mid[i] + (1 - ma[i]) * bg[i]), 1e-6);
  }
  EXPECT_NE(channel(header, 0, "fg.velocity.x"), channel(header, 0, "mid.velocity.x"));
  job.scene = "pan";
  EXPECT_THROW(synth_sequence(job, {}), Failure);
}

TEST_F(SynthSequence, HalfHoldsTheBrightestEmitter) {
  job.scene = "hdr";
  job.width = 0;
  job.height = 0;
  job.frames = {24};
  synth_sequence(job, {});
  const FileHeader header = read_header(path("hdr.0024.exr"));
  EXPECT_EQ(header.parts[0].data_window, (Window{0, 0, 320, 180}));
  const std::vector<float> red = channel(header, 0, "R");
  EXPECT_EQ(*std::max_element(red.begin(), red.end()), 65504.f);
}

TEST_F(SynthSequence, AGapInTheJitterTableStopsBeforeAnythingIsWritten) {
  job.scene = "pan";
  std::ofstream(folder / "j.csv") << "frame,jx,jy\n1,0.1,0.2\n";
  job.jitter = path("j.csv");
  job.frames = {1, 2};
  job.folder = path("out");
  try {
    synth_sequence(job, {});
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::inconsistent);
    EXPECT_NE(std::string(failure.what()).find("frame 2"), std::string::npos) << failure.what();
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(SynthSequence, NewFilesKeepTheirAttributes) {
  const Window data{-3, 2, 5, 9}, display{0, 0, 16, 12};
  RawPlane plane = make_raw_plane(PixelType::float32, data);
  for (int y = 0; y < plane.rows; ++y) std::memset(plane.row(y), 0, std::size_t(plane.columns) * 4);
  std::vector<double> matrix(16);
  for (int i = 0; i < 16; ++i) matrix[std::size_t(i)] = i * 0.25;
  for (const Compression compression : {Compression::none, Compression::zip, Compression::piz}) {
    NewPart part{"only", data, display, compression, {{{"Y", PixelType::float32}, &plane}}, {}};
    part.attributes = {string_attribute("note", "a b"), number_attribute("count", "int", {-7}),
                       number_attribute("jitter", "v2f", {0.5, -0.25}), number_attribute("m", "m44f", matrix)};
    write_new_file(path("new.exr"), {&part, 1}, 4, workers);
    const FileHeader header = read_header(path("new.exr"));
    ASSERT_EQ(header.parts.size(), 1u);
    EXPECT_EQ(header.parts[0].data_window, data);
    EXPECT_EQ(header.parts[0].display_window, display);
    EXPECT_EQ(header.parts[0].compression, compression);
    EXPECT_EQ(header.parts[0].attribute("note")->text, "a b");
    EXPECT_EQ(header.parts[0].attribute("count")->numbers, std::vector<double>{-7});
    EXPECT_EQ(header.parts[0].attribute("jitter")->numbers, (std::vector<double>{0.5, -0.25}));
    EXPECT_EQ(header.parts[0].attribute("m")->numbers, matrix);
    EXPECT_TRUE(has_every_chunk(path("new.exr")));
  }
  NewPart wrong{"", data, display, Compression::zip, {{{"Y", PixelType::float32}, &plane}}, {}};
  wrong.attributes = {number_attribute("jitter", "v2f", {1})};
  EXPECT_THROW(write_new_file(path("wrong.exr"), {&wrong, 1}, 4, workers), Failure);
  wrong.attributes.clear();
  wrong.data_window = {0, 0, 100, 100};
  EXPECT_THROW(write_new_file(path("wrong.exr"), {&wrong, 1}, 4, workers), Failure);
  EXPECT_FALSE(fs::exists(path("wrong.exr")));
}

}  // namespace
}  // namespace varve
