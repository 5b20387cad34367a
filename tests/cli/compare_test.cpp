// varve compare as a user meets it: two valid sequences, then the same with one thing changed.
#include <gtest/gtest.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <fstream>
#include <functional>
#include <limits>

#include "program.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// A float picture; `change` may alter anything.
struct Picture {
  int width = 40, height = 32;
  std::string prefix = {};  ///< of the channel names
  std::vector<std::string> channels = {"R", "G", "B", "A"};
  float offset = 0;
  std::function<float(int frame, int x, int y, float value)> change = {};
  std::string date = {};
  Imath::V2i origin = {0, 0};
};

float value_at(const Picture& p, int frame, int x, int y, std::size_t channel) {
  const float value = channel == 3 ? 1.f : 0.1f + 0.01f * float((x * 7 + y * 3 + frame * 5) % 50) + p.offset;
  return p.change && channel == 1 ? p.change(frame, x, y, value) : value;
}

void write_picture(const std::filesystem::path& path, int frame, const Picture& p) {
  const Imath::Box2i window(p.origin, p.origin + Imath::V2i(p.width - 1, p.height - 1));
  Imf::Header header(window, window);
  if (!p.date.empty()) header.insert("Date", Imf::StringAttribute(p.date));
  if (!p.date.empty()) header.insert("scene", Imf::StringAttribute("s" + p.date));
  Imf::FrameBuffer pixels;
  std::vector<std::vector<float>> planes;
  for (std::size_t c = 0; c < p.channels.size(); ++c) {
    planes.emplace_back();
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) planes.back().push_back(value_at(p, frame, x, y, c));
  }
  for (std::size_t c = 0; c < p.channels.size(); ++c) {
    header.channels().insert(p.prefix + p.channels[c], Imf::Channel(Imf::FLOAT));
    pixels.insert(p.prefix + p.channels[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), window));
  }
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(pixels);
  file.writePixels(p.height);
}

class Compare : public testing::Test {
 protected:
  void SetUp() override { write("a", {}); }
  void write(const std::string& name, const Picture& picture, int first = 1, int last = 3) {
    for (int frame = first; frame <= last; ++frame)
      write_picture(folder / (name + ".000" + std::to_string(frame) + ".exr"), frame, picture);
  }
  Outcome run(const std::vector<std::string>& more = {}, const std::string& a = "a.####.exr",
              const std::string& b = "b.####.exr") const {
    std::vector<std::string> line = {"compare", a, b};
    line.insert(line.end(), more.begin(), more.end());
    return run_varve(line, folder.path());
  }
  /// One pixel of G in frame 2.
  static Picture with_pixel(float value) {
    return {.change = [value](int frame, int x, int y, float v) { return frame == 2 && x == 9 && y == 4 ? value : v; }};
  }
  Folder folder;
};

void expect_verdict(const Outcome& outcome, int code, const std::string& word) {
  EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("Verdict  " + word), std::string::npos) << outcome.out;
}

TEST_F(Compare, EqualSequences) {
  write("b", {});
  expect_verdict(run(), 0, "equal");
  expect_verdict(run({"--channels", "all", "--fail", "max=0"}), 0, "equal");
}

TEST_F(Compare, ANameIsNoDifference) {
  write("b", {.prefix = "ViewLayer.Combined."});
  expect_verdict(run(), 0, "equal");
}

TEST_F(Compare, NotFiniteFailsWhateverItMeets) {
  write("b", with_pixel(kNan));
  write("c", with_pixel(kInf));
  write("d", with_pixel(-kInf));
  const std::vector<std::string> generous = {"--fail", "psnr=1", "--fail", "max=1e9"};
  for (const char* b : {"b.####.exr", "c.####.exr", "d.####.exr"}) {
    expect_verdict(run({}, "a.####.exr", b), 1, "beyond");
    expect_verdict(run({}, b, "a.####.exr"), 1, "beyond");
    expect_verdict(run(generous, "a.####.exr", b), 1, "beyond");
  }
  expect_verdict(run(generous, "c.####.exr", "d.####.exr"), 1, "beyond");
  EXPECT_NE(run({}, "c.####.exr", "d.####.exr").out.find("not-finite of main in frame 2 is 1"), std::string::npos);
  expect_verdict(run({}, "c.####.exr", "c.####.exr"), 0, "equal");
  expect_verdict(run({}, "b.####.exr", "b.####.exr"), 1, "beyond");
  expect_verdict(run({"--nan-equal"}, "b.####.exr", "b.####.exr"), 0, "equal");
  expect_verdict(run({"--fail", "not-finite=1"}, "a.####.exr", "b.####.exr"), 0, "within");
}

TEST_F(Compare, LimitsDecide) {
  write("b", {.offset = 0.01f});
  expect_verdict(run(), 1, "beyond");
  expect_verdict(run({"--fail", "psnr=39.9"}), 0, "within");  // 0.01 is 40 dB
  expect_verdict(run({"--fail", "psnr=40.1"}), 1, "beyond");
  expect_verdict(run({"--fail", "max=0.011", "--warn", "psnr=90"}), 0, "within");
  EXPECT_NE(run({"--fail", "max=0.011", "--warn", "psnr=90"}).out.find("warning: psnr"), std::string::npos);
  expect_verdict(run({"--fail", "lag=5"}), 1, "beyond");  // cannot be measured without a cut
  expect_verdict(run({"--fail", "flicker=1e-9", "--fail", "bias=1.01e-4"}), 0, "within");
}

TEST_F(Compare, EachFrameMustHoldALimit) {
  write("b", with_pixel(0.9f));
  const Outcome outcome = run({"--fail", "max=0.1"});
  expect_verdict(outcome, 1, "beyond");
  EXPECT_NE(outcome.out.find("frame 2"), std::string::npos);
  expect_verdict(run({"--fail", "max=0.1", "--frames", "3"}), 0, "equal");
}

TEST_F(Compare, WindowsMustBeTheSame) {
  write("b", {.width = 39});
  write("c", {.origin = {4, 4}});
  write("d", {.origin = {100, 0}});
  for (const char* b : {"b.####.exr", "c.####.exr", "d.####.exr"}) {
    const Outcome outcome = run({"--fail", "psnr=1"}, "a.####.exr", b);
    expect_verdict(outcome, 4, "incomparable");
    expect_refused({outcome.code, "", outcome.err}, 4, "window");
  }
  EXPECT_LE(run({"--window", "common"}).code, 1);
  EXPECT_EQ(run({"--window", "common"}, "a.####.exr", "d.####.exr").code, 4);
}

TEST_F(Compare, ChannelsThatLackAreTold) {
  write("b", {.channels = {"R", "G", "B"}});
  expect_verdict(run({"--fail", "max=1"}), 1, "beyond");
  EXPECT_NE(run().out.find("channel A is only in A"), std::string::npos);
  write("c", {.channels = {"R", "G", "B", "A", "extra"}});
  expect_verdict(run({}, "a.####.exr", "c.####.exr"), 0, "equal");
  expect_verdict(run({"-c", "all", "--fail", "max=1"}, "a.####.exr", "c.####.exr"), 1, "beyond");
  EXPECT_EQ(run({"-c", "nowhere"}).code, 4);
}

TEST_F(Compare, FramesThatLackCount) {
  write("b", {}, 2, 4);
  const Outcome outcome = run({"--fail", "max=1"});
  expect_verdict(outcome, 1, "beyond");
  EXPECT_NE(outcome.out.find("frames only in A: 1"), std::string::npos);
  EXPECT_NE(outcome.out.find("frames only in B: 4"), std::string::npos);
  expect_verdict(run({"--fail", "missing=2"}), 0, "within");
  expect_verdict(run({"--frames", "2-3"}), 0, "equal");
  write("c", {}, 7, 8);
  expect_verdict(run({}, "a.####.exr", "c.####.exr"), 4, "incomparable");
}

TEST_F(Compare, AttributesOnlyWhenAsked) {
  write("b", {.date = "today"});
  write("c", {.date = "tomorrow"});
  expect_verdict(run({}, "b.####.exr", "c.####.exr"), 0, "equal");
  const Outcome outcome = run({"--attributes"}, "b.####.exr", "c.####.exr");
  expect_verdict(outcome, 1, "beyond");
  EXPECT_NE(outcome.out.find("attribute scene differs"), std::string::npos);
  EXPECT_EQ(outcome.out.find("Date"), std::string::npos);
}

TEST_F(Compare, ReportsAreWrittenAndTheSameForAnyThreads) {
  write("b", {.offset = 0.25f});
  const auto with_threads = [&](const char* threads) {
    const Outcome outcome = run({"-j", threads, "--json", "-", "--csv", "r.csv", "--html", "r.html"});
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_TRUE(outcome.out.starts_with("{\"a\":") && outcome.out.ends_with("]}\n")) << outcome.out;
    return outcome.out + bytes_of(folder / "r.csv") + bytes_of(folder / "r.html");
  };
  const std::string one = with_threads("1");
  EXPECT_EQ(one, with_threads("3"));
  EXPECT_NE(one.find("</html>"), std::string::npos);
  for (const char* remote : {"http:", "https:", "src='/", "url("})
    EXPECT_EQ(one.find(remote), std::string::npos) << "the page must need nothing else: " << remote;
  EXPECT_EQ(run({"--json", "nowhere/x.json"}).code, 5);
}

TEST_F(Compare, WorksOnWhatResolveReadsToo) {
  write_small_sequence(folder.path());
  expect_verdict(run({"-c", "all"}, "in.####.exr", "in.####.exr"), 0, "equal");
  write_small_frame(folder / "x.0001.exr", 2);
  const Outcome outcome = run({"-c", "ViewLayer.IndexOB.X"}, "in.####.exr", "x.####.exr");
  EXPECT_EQ(outcome.code, 1) << outcome.out << outcome.err;
}

TEST_F(Compare, OneThingDamaged) {
  expect_refused(run(), 3, "b.####.exr");
  write("b", {});
  std::ofstream(folder / "b.0002.exr") << "this is no picture";
  expect_refused(run(), 3, "b.0002.exr");
  expect_refused(run_varve({"compare", "a.####.exr"}, folder.path()), 2, "A B");
  expect_refused(run({"--fail", "psnr"}), 2, "--fail");
  expect_refused(run({"--fail", "psnr=nan"}), 2, "--fail");
  expect_refused(run({"--metrics", "psnr,nonsense"}), 2, "--metrics");
  expect_refused(run({"--edge", "1,2,3"}), 2, "--edge");
}

}  // namespace
}  // namespace varve::test
