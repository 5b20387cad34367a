#include "exr/jitter.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "paths.h"
#include "support/refusal.h"

namespace varve {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using test::message_of;

Part part_with(std::vector<Attribute> attributes) {
  Part part;
  part.attributes = std::move(attributes);
  return part;
}

Part part_with_note(const std::string& note) { return part_with({{"Note", "string", note, {}}}); }

/// A sidecar that is gone when the test is over.
struct Sidecar {
  explicit Sidecar(const std::string& text) {
    path = (std::filesystem::temp_directory_path() / ("varve_jitter_" + std::to_string(getpid()) + ".csv")).string();
    std::ofstream(path, std::ios::binary) << text;
  }
  ~Sidecar() { std::filesystem::remove(path); }
  std::string path;
};

TEST(Jitter, HaltonCountsFromFrameOneAndRepeats) {
  const JitterSource source = parse_jitter_source("halton23");
  const Part part;
  EXPECT_NEAR(jitter_of(source, part, 1)->x, 0.0, 1e-15);
  EXPECT_NEAR(jitter_of(source, part, 1)->y, 1.0 / 3 - 0.5, 1e-15);
  EXPECT_NEAR(jitter_of(source, part, 2)->x, -0.25, 1e-15);
  const JitterSource four = parse_jitter_source("halton23:4");
  for (const int frame : {-2147483647 - 1, -5, 0, 1, 2, 3, 4, 9, 2147483647}) {
    const Jitter here = *jitter_of(four, part, frame),
                 again = *jitter_of(four, part, frame > 0 ? frame - 4 : frame + 4);
    EXPECT_EQ(here.x, again.x);
    EXPECT_EQ(here.y, again.y);
    EXPECT_LT(std::max(std::abs(here.x), std::abs(here.y)), 0.5);
  }
}

TEST(Jitter, HaltonIsWhatTheRenderersUsed) {
  const std::string path = VARVE_DATA "/courtyard/jit/jitter.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no development data";
  const JitterSource table = parse_jitter_source(path), halton = parse_jitter_source("halton23:16");
  ASSERT_EQ(table.table.size(), 16u);
  for (const auto& [frame, jitter] : table.table) {
    EXPECT_NEAR(jitter_of(halton, {}, frame)->x, jitter.x, 1e-6);
    EXPECT_NEAR(jitter_of(halton, {}, frame)->y, jitter.y, 1e-6);
  }
  EXPECT_FALSE(jitter_of(table, {}, 17));
}

TEST(Jitter, SidecarWithSamplesTakesTheFirstAndSaysSo) {
  const Sidecar file("# about\r\n\r\nframe, sample, jx, jy\r\n5,0,0.25,-0.5\r\n5,1,1,1\r\n6,0,+0.1,1e-2\r\n");
  const JitterSource source = parse_jitter_source(file.path);
  ASSERT_EQ(source.table.size(), 2u);
  EXPECT_EQ(source.table.at(5).x, 0.25);
  EXPECT_EQ(source.table.at(6).y, 0.01);
  EXPECT_NE(source.description.find("sample 0"), std::string::npos);
}

TEST(Jitter, BadLinesAreNamedByPathAndNumber) {
  const struct {
    const char* text;
    const char* place;
  } cases[] = {{"frame,jx,jy\n1,0,0\n2,0.1\n", ":3:"},
               {"frame,jx,jy\n1,0,0,0\n", ":2:"},
               {"frame,jx,jy\n1,a,0\n", ":2:"},
               {"frame,jx,jy\n1.5,0,0\n", ":2:"},
               {"frame,jx,jy\n1,0.5 x,0\n", ":2:"},
               {"frame,jx,jy\n1,1.5,0\n", ":2:"},
               {"frame,jx,jy\n1,nan,0\n", ":2:"},
               {"frame,jx,jy\n1,0,inf\n", ":2:"},
               {"frame,jx,jy\n# c\n1,0,0\n1,0,0\n", ":4:"},
               {"1,0,0\n", ":1:"},
               {"frame,sample,jx,jy\n1,0,0\n", ":2:"},
               {"frame,jx,jy\n99999999999,0,0\n", ":2:"},
               {"frame,jx,jy\n1,+-0.5,0\n", ":2:"}};
  for (const auto& c : cases) {
    const Sidecar file(c.text);
    EXPECT_NE(message_of([&] { parse_jitter_source(file.path); }, ExitCode::input).find(file.path + c.place),
              std::string::npos)
        << c.text;
  }
  const Sidecar empty("frame,jx,jy\n");
  message_of([&] { parse_jitter_source(empty.path); }, ExitCode::input);
  message_of([] { parse_jitter_source("no/such/file.csv"); }, ExitCode::input);
  message_of([] { parse_jitter_source("/tmp/"); }, ExitCode::input);
}

TEST(Jitter, UnknownNamesAreRefused) {
  for (const char* name :
       {"", "halton", "halton23:", "halton23:0", "halton23:-1", "halton23:16x", "halton23:99999999999", "sobol"})
    message_of([&] { parse_jitter_source(name); }, ExitCode::usage);
  EXPECT_FALSE(jitter_of(parse_jitter_source("none"), part_with_note(R"({"jitter":[0.1,0.2]})"), 1));
}

TEST(Jitter, HeaderGivesAttributeThenNote) {
  const JitterSource automatic = parse_jitter_source("auto");
  EXPECT_EQ(jitter_of(automatic, part_with_note(R"({"frame":1,"jitter":[0.5,-0.25]})"), 1)->y, -0.25);
  const Part both =
      part_with({{"Note", "string", R"({"jitter":[0.5,-0.25]})", {}}, {"jitter", "v2f", "", {0.125, 0.5}}});
  EXPECT_EQ(jitter_of(automatic, both, 1)->x, 0.125);
  EXPECT_FALSE(jitter_of(automatic, Part{}, 1));
  for (const char* note :
       {"shot by the second unit", "{\"jitter\":[0.1]}", "{\"jitter\":\"0.1,0.2\"}", "{\"jitter\":[0.1,0.2]", "[]"})
    EXPECT_FALSE(jitter_of(automatic, part_with_note(note), 1)) << note;
  EXPECT_FALSE(jitter_of(automatic, part_with({{"jitter", "string", "0.1", {}}}), 1));
}

TEST(Jitter, MoreThanAPixelInTheHeaderIsRefused) {
  for (const double bad : {1.01, -3.0, kNaN, std::numeric_limits<double>::infinity()})
    message_of([&] { jitter_of({}, part_with({{"jitter", "v2f", "", {0, bad}}}), 3); }, ExitCode::inconsistent);
  EXPECT_TRUE(jitter_of({}, part_with({{"jitter", "v2f", "", {1, -1}}}), 3));
}

}  // namespace
}  // namespace varve
