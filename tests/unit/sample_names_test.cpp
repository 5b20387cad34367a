// Which parts, layers and pixels are samples of one pixel, and where each of them lies.
#include <gtest/gtest.h>

#include "exr/sample_grid.h"
#include "exr/sample_names.h"
#include "exr/sample_outputs.h"
#include "exr_test_files.h"
#include "support/refusal.h"

namespace varve {
namespace {

using test::message_of;

std::string parsed(const std::string& name) {
  const std::optional<SampleName> sample = parse_sample_name(name);
  return sample ? std::to_string(sample->number) + ":" + sample->stem : "-";
}

TEST(SampleNames, AreAWordWithANumber) {
  EXPECT_EQ(parsed("sample.0"), "0:");
  EXPECT_EQ(parsed("s12"), "12:");
  EXPECT_EQ(parsed("beauty.Sample_3"), "3:beauty");
  EXPECT_EQ(parsed("sample.2.diffuse.R"), "2:diffuse.R");
  EXPECT_EQ(parsed("left.subpixel-7.Z"), "7:left.Z");
  for (const char* const other :
       {"R", "s", "s.0", "sample", "sample.R", "sky3", "s0a", "crypto00", "s1234567", "3", ""})
    EXPECT_EQ(parsed(other), "-") << other;
}

std::string choose(const std::vector<std::string>& layers, const std::vector<std::string>& asked = {}) {
  std::vector<NamedLayer> list;
  for (const std::string& layer : layers) list.push_back({"", layer});
  std::string text;
  for (const std::size_t place : choose_samples(list, asked, "x.exr").layers) text += layers[place] + " ";
  return text;
}

TEST(SampleNames, SamplesGoInTheOrderOfTheirNumbers) {
  EXPECT_EQ(choose({"s10", "s2", "s1", "s3", "s4", "s5", "s6", "s7", "s8", "s9"}), "s1 s2 s3 s4 s5 s6 s7 s8 s9 s10 ");
  EXPECT_EQ(choose({"sample.1", "R", "sample.0"}), "sample.0 sample.1 ");
  EXPECT_EQ(choose({"spec.s0", "spec.s1", "beauty.s0", "beauty.s1"}), "beauty.s0 beauty.s1 ");
  EXPECT_EQ(choose({"spec.s0", "spec.s1", "beauty.s0", "beauty.s1"}, {"spec"}), "spec.s0 spec.s1 ");
}

TEST(SampleNames, WhatIsMissingOrDoubledIsRefusedWithARemedy) {
  const std::string none = message_of([] { choose({"fg", "bg"}); });
  EXPECT_NE(none.find("sample.0"), std::string::npos);
  EXPECT_NE(none.find("fg, bg"), std::string::npos);
  EXPECT_NE(none.find("grid:N"), std::string::npos);
  EXPECT_NE(message_of([] { choose({}); }).find("grid:N"), std::string::npos);
  EXPECT_NE(message_of([] { choose({"s0", "s1", "s3"}); }).find("sample 2"), std::string::npos);
  EXPECT_NE(message_of([] { choose({"s5", "s6"}); }).find("sample 0"), std::string::npos);
  EXPECT_NE(message_of([] { choose({"s0", "sample.0"}); }).find("twice"), std::string::npos);
  EXPECT_NE(message_of([] { choose({"s0", "s1"}, {"fog"}); }).find("fog"), std::string::npos);
}

Part part_of(const std::string& name, const std::vector<std::string>& channels, const Window& window = {0, 0, 8, 6}) {
  Part part;
  part.name = name;
  part.data_window = part.display_window = window;
  for (const std::string& channel : channels) part.channels.push_back({channel, PixelType::float16, 1, 1, false});
  return part;
}

const std::vector<std::string> kChannels = {"A", "B", "G", "R", "Z", "velocity.x", "velocity.y"};

RoleRequest resolve_request() {
  RoleRequest request;
  request.samples.mode = SampleMode::resolve;
  request.convention = "varve";
  return request;
}

TEST(SampleOutputs, PartsBecomeOneColorInThePlaceOfTheOneNearestToTheCenter) {
  const std::vector<FileHeader> files = {
      {"x.exr", {part_of("sample.1", kChannels), part_of("sample.0", kChannels)}, {}, 0}};
  const RoleRequest request = resolve_request();
  const std::vector<Subject> subjects = find_subjects(files, request);
  ASSERT_EQ(subjects.size(), 2u);
  EXPECT_EQ(subjects[0].layer, "sample.0");
  EXPECT_EQ(part_of(subjects[0]), 1);
  EXPECT_EQ(subjects[0].depth->part, 1);
  EXPECT_EQ((*subjects[1].backward)[0].part, 0);
  const std::vector<std::optional<Jitter>> near_second = {Jitter{0.4, 0.4}, Jitter{0.1, -0.2}}, unknown(2);
  const std::vector<ColorOutput> outputs = sample_outputs(subjects, request.samples, near_second);
  ASSERT_EQ(outputs.size(), 1u);
  EXPECT_EQ(outputs[0].subject.layer, "");
  EXPECT_EQ(outputs[0].subject.place.part, 0);
  EXPECT_EQ(outputs[0].subject.place.channels[0]->name, "R");
  EXPECT_EQ(outputs[0].inputs, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(sample_outputs(subjects, request.samples, unknown)[0].subject.place.part, 1);
  const PassedOn passed = passed_on_of_samples(files[0], outputs, subjects, request.samples);
  EXPECT_EQ(passed.dropped.size(), kChannels.size());
  EXPECT_EQ(passed.dropped[0].part, 1);
  EXPECT_TRUE(passed.renamed.empty());
}

TEST(SampleOutputs, LayersOfOnePartLoseTheirNumbers) {
  std::vector<std::string> names;
  for (const std::string layer : {"s0.", "s1."})
    for (const std::string& channel : kChannels) names.push_back(layer + channel);
  names.push_back("crypto00.R");
  const std::vector<FileHeader> files = {{"x.exr", {part_of("", names)}, {}, 0}};
  const RoleRequest request = resolve_request();
  const std::vector<Subject> subjects = find_subjects(files, request);
  ASSERT_EQ(subjects.size(), 2u);
  const std::vector<std::optional<Jitter>> unknown(2);
  const std::vector<ColorOutput> outputs = sample_outputs(subjects, request.samples, unknown);
  EXPECT_EQ(outputs.at(0).subject.place.channels[3]->name, "A");
  const PassedOn passed = passed_on_of_samples(files[0], outputs, subjects, request.samples);
  EXPECT_EQ(passed.dropped.size(), 7u);
  ASSERT_EQ(passed.renamed.size(), 7u);
  EXPECT_EQ(passed.renamed[4].second, "Z");
  EXPECT_EQ(passed.renamed[5].second, "velocity.x");
}

TEST(SampleOutputs, UnlikeSamplesAreRefused) {
  const auto refusal = [](Part second) {
    return message_of([&] {
      const std::vector<FileHeader> files = {{"x.exr", {part_of("sample.0", kChannels), second}, {}, 0}};
      const RoleRequest request = resolve_request();
      const std::vector<Subject> subjects = find_subjects(files, request);
      const std::vector<std::optional<Jitter>> unknown(2);
      check_samples_alike(files[0], sample_outputs(subjects, request.samples, unknown), subjects);
    });
  };
  EXPECT_NE(refusal(part_of("sample.1", kChannels, {0, 0, 8, 7})).find("windows"), std::string::npos);
  EXPECT_NE(refusal(part_of("sample.1", {"B", "G", "R", "Z", "velocity.x", "velocity.y"})).find("channel A"),
            std::string::npos);
  EXPECT_NE(refusal(part_of("sample.1", {"A", "B", "G", "R", "velocity.x", "velocity.y"})).find("depth"),
            std::string::npos);
}

TEST(SampleGrid, APixelOfTheFileIsAPlaceInAPixel) {
  // 2x2 without a jitter: the centers of quarters.
  EXPECT_EQ(jitter_of_cell(std::nullopt, 0, 2).x, -0.25);
  EXPECT_EQ(jitter_of_cell(std::nullopt, 1, 2).x, 0.25);
  EXPECT_EQ(jitter_of_cell(std::nullopt, 1, 2).y, -0.25);
  EXPECT_EQ(jitter_of_cell(std::nullopt, 2, 2).y, 0.25);
  // Position in the file, divided by n, against the center of the pixel it falls in.
  const Jitter stored{0.3, -0.4};
  for (const int n : {2, 3, 4})
    for (int cell = 0; cell < n * n; ++cell) {
      const Jitter j = jitter_of_cell(stored, cell, n);
      const double x = (5 * n + cell % n + 0.5 + stored.x) / n, y = (-2 * n + cell / n + 0.5 + stored.y) / n;
      EXPECT_NEAR(j.x, x - 5.5, 1e-12);
      EXPECT_NEAR(j.y, y + 1.5, 1e-12);
    }
}

TEST(SampleGrid, CellsAreTheStoredBits) {
  const test::Folder folder;
  Imf::Header header(6, 4);
  header.dataWindow() = Imath::Box2i({-3, 3}, {5, 8});
  header.displayWindow() = Imath::Box2i({0, 0}, {8, 8});
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  const auto truth = test::write_stock(folder / "a.exr", {header});
  const FileHeader stored = read_header(folder / "a.exr"), cell = header_of_cell(stored, 3),
                   cells = header_of_cells(cell, 3);
  EXPECT_EQ(cell.parts[0].data_window, (Window{-1, 1, 2, 3}));
  ASSERT_EQ(cells.parts.size(), 9u);
  Workers workers(2);
  const std::vector<ChannelRef> wanted = {{0, 5, 0}, {0, 5, 1}, {0, 6, 1}};
  const FramePixels split = read_cells(stored, cells, wanted, 3, workers);
  EXPECT_TRUE(split.planes[0][0].empty());
  for (const ChannelRef& ref : wanted) {
    const RawPlane& plane = split[ref];
    const test::Pixels& whole = truth[0].at(ref.channel == 0 ? "R" : "id");
    ASSERT_EQ(plane.columns, 3);
    ASSERT_EQ(plane.rows, 2);
    std::string expected;
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        expected += whole.bytes.substr(
            std::size_t(((y * 3 + ref.part / 3) * whole.columns + x * 3 + ref.part % 3) * whole.size),
            std::size_t(whole.size));
    EXPECT_TRUE(test::packed(plane) == expected);
  }
}

TEST(SampleGrid, WhatDoesNotDivideIsRefusedWithARemedy) {
  const auto refusal = [](Part part, int n) {
    return message_of([&] { header_of_cell({"x.exr", {part}, {}, 0}, n); });
  };
  EXPECT_NE(refusal(part_of("", kChannels, {0, 0, 8, 7}), 2).find("multiples of 2"), std::string::npos);
  EXPECT_NE(refusal(part_of("", kChannels, {1, 0, 9, 6}), 2).find("1,0"), std::string::npos);
  EXPECT_NE(refusal(part_of("", kChannels), 3).find("3x3"), std::string::npos);
  Part chroma = part_of("", kChannels);
  chroma.channels[1].x_sampling = 2;
  EXPECT_NE(refusal(chroma, 2).find("subsampled"), std::string::npos);
  Part deep = part_of("", kChannels);
  deep.storage = Storage::deep_scanline;
  EXPECT_NE(refusal(deep, 2).find("flatten"), std::string::npos);
}

TEST(SampleGrid, VectorsInPixelsAreDividedOthersStay) {
  Subject s;
  s.color[0] = ChannelRef{0, 1, 0};
  s.depth = ChannelRef{1, 0, 2};
  s.backward_encoding = {.scale = 3, .unit = MotionUnit::pixel};
  s.forward_encoding = {.scale = 3, .unit = MotionUnit::ndc};
  const std::vector<int> parts = {2, 1};
  const std::vector<Subject> all = subjects_of_cells({&s, 1}, parts, 2);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[3].color[0]->part, 1 + 3 * 2);
  EXPECT_EQ(all[3].depth->part, 3);
  EXPECT_EQ(all[3].backward_encoding.scale, 1.5);
  EXPECT_EQ(all[3].forward_encoding.scale, 3);
}

TEST(SampleJitter, EachSampleHasItsOwn) {
  const test::Folder folder;
  test::spill(folder / "j.csv", "frame,sample,jx,jy\n1,0,0.1,0.2\n1,1,0.3,-0.4\n2,0,0,0\n");
  const JitterSource table = parse_jitter_source(folder / "j.csv");
  const Part part;
  EXPECT_EQ(jitter_of_sample(table, part, 1, 1, 2)->y, -0.4);
  EXPECT_EQ(jitter_of_sample(table, part, 1, 0, 2)->x, 0.1);
  EXPECT_FALSE(jitter_of_sample(table, part, 2, 1, 2));
  test::spill(folder / "plain.csv", "frame,jx,jy\n1,0.1,0.2\n");
  EXPECT_FALSE(jitter_of_sample(parse_jitter_source(folder / "plain.csv"), part, 1, 0, 2));
  test::spill(folder / "twice.csv", "frame,sample,jx,jy\n1,1,0.1,0.2\n1,1,0.3,-0.4\n");
  EXPECT_NE(message_of([&] { parse_jitter_source(folder / "twice.csv"); }, ExitCode::input).find("sample 1"),
            std::string::npos);
  // As varve synth and data/samples4 count: sample k of frame f is point S (f - 1) + k + 1.
  const JitterSource pattern = with_samples(parse_jitter_source("halton23:16"), 4),
                     points = parse_jitter_source("halton23:64");
  for (const int frame : {1, 2, 16, 17})
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(jitter_of_sample(pattern, part, frame, k, 4)->x, jitter_of(points, part, 4 * (frame - 1) + k + 1)->x);
}

}  // namespace
}  // namespace varve
