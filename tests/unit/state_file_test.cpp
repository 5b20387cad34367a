// Files of --state-out: every member of what is remembered, bit for bit, and nothing taken on trust.
#include "stages/state_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>
#include <utility>

#include "exr_test_files.h"
#include "stages/state_planes.h"

namespace varve::test {
namespace {

/// Stands for any member of an aggregate.
struct Anything {
  template <class T>
  operator T() const;
};
template <class T, std::size_t... I>
constexpr bool can_be_made_of(std::index_sequence<I...>) {
  return requires { T{(static_cast<void>(I), Anything{})...}; };
}
/// How many members an aggregate has: one more cannot be given.
template <class T, std::size_t N = 1>
constexpr std::size_t members() {
  if constexpr (can_be_made_of<T>(std::make_index_sequence<N>()))
    return members<T, N + 1>();
  else
    return N - 1;
}

template <class T>
std::size_t visited() {
  T value;
  std::size_t count = 0;
  visit_members(value, [&](const char*, auto&&) { ++count; });
  return count;
}

TEST(StatePlanes, NoMemberIsForgotten) {
  struct Two {
    int a = 0;
    std::vector<int> b = {};
  };
  static_assert(members<Two>() == 2);
  const char* remedy = "a member was added: give it its line in stages/state_planes.h";
  EXPECT_EQ(visited<History>(), members<History>()) << remedy;
  EXPECT_EQ(visited<ForwardMemory>(), members<ForwardMemory>()) << remedy;
  EXPECT_EQ(visited<SeenPlanes>(), members<SeenPlanes>()) << remedy;
  EXPECT_EQ(visited<SubpixelBuffer>(), members<SubpixelBuffer>()) << remedy;
  EXPECT_EQ(visited<SubpixelHistory>(), members<SubpixelHistory>()) << remedy;
  EXPECT_EQ(visited<SubjectState>(), members<SubjectState>()) << remedy;
}

/// Fills every leaf with numbers of its own.
struct Fill {
  std::mt19937& random;
  Window window;

  template <class T>
  void operator()(const std::string&, Plane<T>& plane) const {
    plane = Plane<T>(window);
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x)
        for (std::size_t i = 0; i < sizeof(T) / 4; ++i) {
          const float value = float(random() % 1000) / 8;
          std::memcpy(reinterpret_cast<char*>(&plane.at(x, y)) + 4 * i, &value, 4);
        }
  }
  template <class T>
  void operator()(const std::string& name, std::vector<Plane<T>>& planes) const {
    planes.resize(2);
    for (Plane<T>& plane : planes) (*this)(name, plane);
  }
  void operator()(const std::string&, std::vector<std::uint8_t>& bytes) const {
    bytes.resize(std::size_t(window.height()));
    for (std::uint8_t& byte : bytes) byte = std::uint8_t(random() % 2);
  }
  void operator()(const std::string&, glm::dvec2& pair) const { pair = {double(random()), 0.25}; }
  void operator()(const std::string&, int& number) const { number = int(random() % 100); }
};

/// All leaves as text with their names.
struct Print {
  std::map<std::string, std::string>& leaves;

  template <class T>
  void operator()(const std::string& name, const Plane<T>& plane) const {
    const Window& w = plane.window();
    std::string& text = leaves[name];
    text = std::to_string(w.x0) + "," + std::to_string(w.y0) + ":";
    for (int y = w.y0; y < w.y1; ++y)
      text.append(reinterpret_cast<const char*>(plane.row(y)), sizeof(T) * std::size_t(w.width()));
  }
  template <class T>
  void operator()(const std::string& name, const std::vector<Plane<T>>& planes) const {
    for (std::size_t i = 0; i < planes.size(); ++i) (*this)(name + std::to_string(i), planes[i]);
  }
  void operator()(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    leaves[name] = std::string(bytes.begin(), bytes.end());
  }
  void operator()(const std::string& name, const glm::dvec2& pair) const {
    leaves[name] = std::to_string(pair.x) + " " + std::to_string(pair.y);
  }
  void operator()(const std::string& name, int number) const { leaves[name] = std::to_string(number); }
};

std::map<std::string, std::string> leaves_of(const SubjectState& state) {
  std::map<std::string, std::string> leaves;
  visit_leaves(state, "", Print{leaves});
  return leaves;
}

StateHead some_head() {
  StateHead head;
  head.version = "1.2.3";
  head.parameters = "alpha=0.1";
  head.hash = "0123456789abcdef";
  head.first = -3;
  head.preroll = 2;
  head.frames = {{-3, 7}, {-2, 0xffffffffffffffffull}};
  head.subjects = {"fg", "bg@left"};
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.focal = {3, 4};
  head.cameras.cameras = {camera, std::nullopt};
  head.cameras.jitter = {std::nullopt, glm::dvec2(0.25, -0.5)};
  return head;
}

std::vector<SubjectState> some_states() {
  std::mt19937 random(5);
  std::vector<SubjectState> states(2);
  visit_leaves(states[0], "", Fill{random, {-3, 2, 8, 9}});
  visit_leaves(states[1], "", Fill{random, {0, 0, 5, 1}});
  states[1].history.depth = {};
  states[1].forward = {};
  return states;
}

class StateFile : public testing::Test {
 protected:
  void SetUp() override { write_state(path, some_head(), some_states()); }
  std::string bytes() const {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  void put(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }
  ExitCode refusal() const {
    try {
      read_state(path);
      return ExitCode::done;
    } catch (const Failure& failure) {
      EXPECT_NE(std::string(failure.what()).find(path), std::string::npos);
      return failure.code();
    }
  }
  Folder folder;
  std::string path = (folder.path / "st").string();
};

TEST_F(StateFile, ReadsBackWhatWasWritten) {
  const SavedState read = read_state(path);
  const StateHead head = some_head();
  for (const StateHead& h : {read.head, read_state_head(path)}) {
    EXPECT_EQ(h.version, head.version);
    EXPECT_EQ(h.parameters, head.parameters);
    EXPECT_EQ(h.hash, head.hash);
    EXPECT_EQ(h.first, head.first);
    EXPECT_EQ(h.preroll, head.preroll);
    EXPECT_EQ(h.frames, head.frames);
    EXPECT_EQ(h.subjects, head.subjects);
    EXPECT_EQ(h.cameras.cameras, head.cameras.cameras);
    EXPECT_EQ(h.cameras.jitter, head.cameras.jitter);
  }
  const std::vector<SubjectState> states = some_states();
  ASSERT_EQ(read.subjects.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(leaves_of(read.subjects[k]), leaves_of(states[k]));
  EXPECT_GE(leaves_of(read.subjects[0]).size(), 15u);
  // Equal states, equal bytes.
  const std::string before = bytes();
  write_state(path, read.head, read.subjects);
  EXPECT_EQ(bytes(), before);
}

TEST_F(StateFile, CutOffAnywhereItIsRefused) {
  const std::string whole = bytes();
  for (std::size_t size = 0; size < whole.size(); size += size < 800 ? 1 : 97) {
    put(whole.substr(0, size));
    ASSERT_EQ(refusal(), ExitCode::input) << size;
  }
  put(whole + "x");
  EXPECT_EQ(refusal(), ExitCode::input);
}

TEST_F(StateFile, EveryFlippedBitIsNoticed) {
  const std::string whole = bytes();
  for (std::size_t at = 0; at < whole.size(); at += at < 900 ? 1 : 13) {
    std::string harmed = whole;
    harmed[at] = char(harmed[at] ^ (1 << (at % 8)));
    put(harmed);
    const ExitCode code = refusal();
    ASSERT_TRUE(code == ExitCode::input || (code == ExitCode::inconsistent && at >= 8 && at < 12)) << at;
  }
}

TEST_F(StateFile, AnotherFormatIsRefusedWithItsNumber) {
  std::string later = bytes();
  later[8] = 9;
  put(later);
  try {
    read_state_head(path);
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::inconsistent);
    EXPECT_NE(std::string(failure.what()).find("format 9"), std::string::npos) << failure.what();
  }
}

TEST_F(StateFile, PlanesThatDoNotFitTogetherAreRefusedDespiteTheirChecksums) {
  const auto refused_with = [&](auto harm) {
    std::vector<SubjectState> states = some_states();
    harm(states[0]);
    write_state(path, some_head(), states);
    return refusal() == ExitCode::input;
  };
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.total = Plane<float>(Window{0, 0, 1, 1}, 0, 1.0f); }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.depth = Plane<float>(Window{0, 0, 1, 1}, 0, 1.0f); }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.rows_valid.pop_back(); }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.spread = {}; }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.color.at(0, 4).y = NAN; }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.total.at(0, 4) = -1; }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.history.companions[1].at(0, 4).y = INFINITY; }));
  EXPECT_TRUE(refused_with([](SubjectState& s) { s.forward.depth = Plane<float>(Window{0, 0, 1, 1}, 0, 1.0f); }));
  EXPECT_TRUE(refused_with([](SubjectState& s) {
    s.forward.seen.id = Plane<std::uint32_t>(Window{0, 0, 1, 1}, 0, 1u);
  }));
  EXPECT_FALSE(refused_with([](SubjectState& s) { s.history.depth.at(0, 4) = INFINITY; })) << "background";
  EXPECT_FALSE(refused_with([](SubjectState& s) { s.history.motion.at(0, 4).x = NAN; })) << "unusable";
}

}  // namespace
}  // namespace varve::test
