// varve resolve on a bad night: killed, out of room, shut out, overtaken by a renderer. Nothing half-written is ever
// visible under a final name, and --resume gives the bytes of an undisturbed run.
#include <gtest/gtest.h>

#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <random>
#include <thread>

#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class Faults : public SceneCli {
 protected:
  void SetUp() override { fs::create_directory(folder / "o"); }

  Outcome run(const Arguments& more = {}) const { return resolve_into("in.####.exr", "o", {}, more); }

  static Arguments line(const Arguments& more = {}) {
    Arguments all = {"resolve", "in.####.exr", "-o", "o/o.####.exr"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::map<std::string, std::string> contents(const std::string& of) const {
    std::map<std::string, std::string> files;
    for (const std::string& name : files_below(folder / of)) files[name] = bytes_of(folder / (of + "/" + name));
    return files;
  }

  std::size_t temporaries() const {
    std::size_t count = 0;
    for (const std::string& name : files_below(folder / "o")) count += name.ends_with(".tmp");
    return count;
  }

  void wait_for(Running& running, int frame) const {
    while (!running.finished() && !fs::exists(path("o", frame))) std::this_thread::sleep_for(milliseconds(1));
  }

  /// Frames large enough to be met in the middle of one.
  void write_large(int frames) const {
    write_small_sequence(folder.path(), {.frames = frames, .width = 800, .height = 500});
  }
};

TEST_F(Faults, KilledAtAnyMomentAndResumedToTheSameBytes) {
  write_small_sequence(folder.path(), {.frames = 5, .width = 240, .height = 160});
  std::mt19937 random(7);
  for (const Arguments& more : {Arguments{"--diagnostics", "o/d.####.exr", "--state-out", "o/st"},
                                {"-p", "two-sided"},
                                {"-p", "draft", "--reach", "1"}}) {
    fs::remove_all(folder / "o");
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(run(more).code, 0);
    const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const auto undisturbed = contents("o");
    fs::remove_all(folder / "o");
    fs::create_directory(folder / "o");
    Arguments again = line(more);
    again.push_back("--resume");
    int killed = 0;
    for (int round = 0; round < 4; ++round) {
      Running running(again, folder.path());
      std::this_thread::sleep_for(std::chrono::duration<double>(std::uniform_real_distribution(0.0, whole)(random)));
      running.send(SIGKILL);
      killed += running.wait().code == 128 + SIGKILL;
      for (const auto& [name, bytes] : contents("o"))
        EXPECT_TRUE(name.ends_with(".tmp") || bytes == undisturbed.at(name)) << name;
    }
    EXPECT_GE(killed, 1);
    ASSERT_EQ(run_varve(again, folder.path()).code, 0);
    EXPECT_TRUE(contents("o") == undisturbed) << "the same files with the same bytes, and no others";
  }
}

TEST_F(Faults, LeftoversGoAndWhatIsBeingWrittenStays) {
  write_large(3);
  Running running(line(), folder.path());
  // Alive, and in the middle of a file: with bytes in it, since between its making and its lock it may be taken away.
  std::string written;
  while (!running.finished() && written.empty()) {
    for (const std::string& name : files_below(folder / "o"))
      if (name.ends_with(".tmp")) written = bytes_of(folder / ("o/" + name));
    if (written.empty()) continue;
    ASSERT_TRUE(running.stop());
    if (temporaries() > 0) break;
    running.send(SIGCONT);
    written.clear();
  }
  const std::size_t living = temporaries();
  ASSERT_EQ(living, 1u);
  std::ofstream(folder / "o/.o.0001.exr.varve-00000000-1-0.tmp") << "of another machine, a moment ago";
  std::ofstream(folder / "o/.notes.tmp") << "not ours";
  ASSERT_EQ(run({"-f", "1"}).code, 0);
  EXPECT_EQ(temporaries(), living + 2);
  running.send(SIGKILL);
  running.wait();
  ASSERT_EQ(run({"-f", "1"}).code, 0);
  EXPECT_EQ(temporaries(), 2u);
  fs::last_write_time(folder / "o/.o.0001.exr.varve-00000000-1-0.tmp",
                      fs::file_time_type::clock::now() - std::chrono::hours(25));
  ASSERT_EQ(run({"-f", "1"}).code, 0);
  EXPECT_EQ(temporaries(), 1u);
}

TEST_F(Faults, TwoRunsAtOnceBothEndWell) {
  write_small_sequence(folder.path(), {.frames = 8, .width = 300, .height = 200});
  ASSERT_EQ(run({"--aov", "all"}).code, 0);
  const auto alone = contents("o");
  fs::remove_all(folder / "o");
  fs::create_directory(folder / "o");
  Running one(line({"--aov", "all"}), folder.path()), other(line({"--aov", "all"}), folder.path());
  EXPECT_EQ(one.wait().code, 0);
  EXPECT_EQ(other.wait().code, 0);
  EXPECT_TRUE(contents("o") == alone);
}

TEST_F(Faults, ResumeNoticesAFrameThatWasRenderedAgain) {
  write_small_sequence(folder.path());
  const auto skipped = [&](const Arguments& more) {
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::size_t count = 0;
    for (std::size_t at = 0; (at = outcome.err.find("complete already, skipped", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  ASSERT_EQ(run().code, 0);
  // The same frame once more, or somewhere else: it is what it was.
  write_small_frame(folder / "in.0004.exr", 4);
  EXPECT_EQ(skipped({"--resume"}), 8u);
  // Other pixels under the same name: this frame and all that remember it.
  write_small_frame(folder / "in.0004.exr", 5);
  EXPECT_EQ(skipped({"--resume"}), 3u);
  const std::string resumed = bytes_of(path("o", 8));
  ASSERT_EQ(run().code, 0);
  EXPECT_EQ(bytes_of(path("o", 8)), resumed);
  // A finite window forgets: two frames of look-ahead, in blocks of two.
  const Arguments two_sided = {"-p", "draft", "--reach", "1", "--resume"};
  ASSERT_EQ(run(two_sided).code, 0);
  write_small_frame(folder / "in.0001.exr", 2);
  EXPECT_GE(skipped(two_sided), 5u);
}

TEST_F(Faults, AnInputThatIsRewrittenMeanwhileIsRefusedOrReadAgain) {
  // Rewritten without end: whenever a run ends well, its output must be that of one of the two versions.
  write_large(1);
  fs::rename(folder / "in.0001.exr", folder / "a.exr");
  write_small_frame(folder / "b.exr", 9, {.width = 800, .height = 500});
  std::vector<std::string> allowed;
  for (const char* version : {"a.exr", "b.exr"}) {
    fs::copy_file(folder / version, folder / "in.0001.exr", fs::copy_options::overwrite_existing);
    ASSERT_EQ(run().code, 0);
    allowed.push_back(bytes_of(path("o", 1)));
  }
  ASSERT_NE(allowed[0], allowed[1]);
  const std::string a = bytes_of(folder / "a.exr"), b = bytes_of(folder / "b.exr");
  int good = 0, refused = 0;
  for (int round = 0; round < 6; ++round) {
    fs::remove(path("o", 1));
    Running running(line(), folder.path());
    for (int i = 0; !running.finished(); ++i) {
      // In place, in two steps, as a careless copy does it.
      std::fstream file(folder / "in.0001.exr", std::ios::in | std::ios::out | std::ios::binary);
      const std::string& bytes = i % 2 == 0 ? b : a;
      file.write(bytes.data(), std::streamsize(bytes.size() / 2)).flush();
      std::this_thread::sleep_for(milliseconds(1 + round));
      file.write(bytes.data() + bytes.size() / 2, std::streamsize(bytes.size() - bytes.size() / 2)).flush();
      fs::resize_file(folder / "in.0001.exr", bytes.size());
      std::this_thread::sleep_for(milliseconds(3 * round));
    }
    const Outcome outcome = running.wait();
    const std::string made = bytes_of(path("o", 1));
    if (outcome.code == 0)
      EXPECT_TRUE(made == allowed[0] || made == allowed[1]);
    else
      EXPECT_TRUE(outcome.code == 3 || outcome.code == 4) << outcome.err;
    ++(outcome.code == 0 ? good : refused);
    fs::copy_file(folder / "a.exr", folder / "in.0001.exr", fs::copy_options::overwrite_existing);
  }
  EXPECT_EQ(good + refused, 6);
  EXPECT_GE(refused, 1);
}

TEST_F(Faults, LateFramesAreWaitedFor) {
  write_small_sequence(folder.path(), {.frames = 4});
  ASSERT_EQ(run().code, 0);
  const auto undisturbed = contents("o");
  const std::string late = bytes_of(folder / "in.0003.exr");
  fs::remove_all(folder / "o"), fs::create_directory(folder / "o");
  fs::remove(folder / "in.0003.exr");
  Running running(line({"-f", "1-4", "--wait", "20"}), folder.path());
  std::this_thread::sleep_for(milliseconds(700));
  // First a half, as a renderer leaves it while it works.
  std::ofstream(folder / "in.0003.exr", std::ios::binary) << late.substr(0, late.size() / 2);
  std::this_thread::sleep_for(milliseconds(600));
  EXPECT_FALSE(running.finished());
  std::ofstream(folder / "in.0003.exr", std::ios::binary) << late;
  const Outcome outcome = running.wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("waits for frame 3: 'in.0003.exr' is not there yet; 3 of 4"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("'in.0003.exr' is not complete yet"), std::string::npos) << outcome.err;
  EXPECT_TRUE(contents("o") == undisturbed);

  expect_refused(run({"-f", "1-5", "--wait", "0.3"}), 3, "frame 5: 'in.0005.exr' is not there yet, and nothing has");
  expect_refused(run({"--wait", "1"}), 2, "--frames");
  Running stopped(line({"-f", "1-5", "--wait", "60"}), folder.path());
  std::this_thread::sleep_for(milliseconds(200));
  stopped.send(SIGTERM);
  EXPECT_EQ(stopped.wait().code, 143);
}

TEST_F(Faults, AFolderThatVanishesOnTheWay) {
  write_large(6);
  Running running(line({"--report", "r.json"}), folder.path());
  wait_for(running, 2);
  std::error_code ignored;
  while (fs::exists(folder / "o", ignored)) fs::remove_all(folder / "o", ignored);
  expect_refused(running.wait(), 5, "folder");
  EXPECT_NE(bytes_of(folder / "r.json").find("\"outcome\":\"failed\""), std::string::npos);
}

TEST_F(Faults, TheDiskIsFull) {
  write_large(6);
  ASSERT_EQ(run({"-f", "1"}).code, 0);
  const std::string room = std::to_string(fs::file_size(path("o", 1)) * 5 / 2);  // of two frames and a half
  fs::remove_all(folder / "o"), fs::create_directory(folder / "o");
  if (mount("tmpfs", (folder / "o").c_str(), "tmpfs", 0, ("size=" + room).c_str()) != 0)
    GTEST_SKIP() << "a small file system cannot be mounted here";
  const Outcome outcome = run({"--report", "r.json"});
  for (const std::string& name : files_below(folder / "o")) EXPECT_TRUE(is_complete(folder / ("o/" + name))) << name;
  const std::size_t written = files_below(folder / "o").size();
  umount((folder / "o").c_str());
  expect_refused(outcome, 5, "free some space");
  EXPECT_GE(written, 1u);
  EXPECT_NE(bytes_of(folder / "r.json").find("\"exit_code\":5"), std::string::npos);
}

TEST_F(Faults, FilesMayNotBeThatLarge) {
  write_large(2);
  Running running(line(), folder.path(), [] {
    const rlimit limit = {4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  // Its own messages are files, too, and short.
  expect_refused(running.wait(), 5, "ulimit -f");
  EXPECT_TRUE(files_below(folder / "o").empty());
}

TEST_F(Faults, AFolderThatMayOnlyBeRead) {
  write_small_sequence(folder.path(), {.frames = 2});
  ASSERT_EQ(run().code, 0);
  const auto before = contents("o");
  chmod((folder / "o").c_str(), 0555);
  Running running(line(), folder.path(), [] {
    if (getuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(126);  // nothing stops root
  });
  const Outcome outcome = running.wait();
  chmod((folder / "o").c_str(), 0755);
  if (outcome.code == 126 || outcome.code == 127) GTEST_SKIP() << "another user cannot run the program here";
  expect_refused(outcome, 5, "choose a folder you may write to");
  EXPECT_TRUE(contents("o") == before);
}

TEST_F(Faults, SymbolicLinksAreReplacedAndFoldersFollowed) {
  write_small_sequence(folder.path(), {.frames = 2});
  fs::create_directory(folder / "elsewhere");
  std::ofstream(folder / "elsewhere/published.exr") << "published";
  fs::create_symlink("../elsewhere/published.exr", path("o", 1));
  ASSERT_EQ(run().code, 0);
  EXPECT_FALSE(fs::is_symlink(path("o", 1)));
  EXPECT_TRUE(is_complete(path("o", 1)));
  EXPECT_EQ(bytes_of(folder / "elsewhere/published.exr"), "published");
  fs::create_directory_symlink("elsewhere", folder / "link");
  EXPECT_EQ(resolve_into("in.####.exr", "link", {}, {}).code, 0);
  EXPECT_TRUE(is_complete(folder / "elsewhere/o.0002.exr"));
  // A link to an input is the input.
  fs::remove(path("o", 2));
  fs::create_symlink("../in.0001.exr", path("o", 2));
  expect_refused(run(), 2, "is one of the inputs");
}

}  // namespace
}  // namespace varve::test
