// Runs the built program as a user would.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace varve::test {

struct Outcome {
  int code = -1;  ///< exit code; 128 + n when signal n ended it
  std::string out, err;
};

/// What a run may take; beyond, it ends by a signal or without memory.
struct RunLimits {
  std::size_t memory_mib = 0;  ///< of address space; 0: any; not looked at under sanitizers, which take all there is
  unsigned seconds = 0;        ///< of the processor; 0: any
};

/// Runs varve with these arguments in `folder`.
Outcome run_varve(const std::vector<std::string>& arguments, const std::filesystem::path& folder = ".",
                  const RunLimits& limits = {});

/// A program that still runs, for signals.
class Running {
 public:
  /// `before` is called in the new process, before it becomes the program: limits, another user.
  Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
          const std::function<void()>& before = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal) const;
  bool stop();      ///< SIGSTOP; returns when it stands still, false when it has ended before
  bool finished();  ///< does not wait
  Outcome wait();   ///< waits for the end

 private:
  std::filesystem::path out_, err_;
  int process_ = -1, status_ = 0;
  bool done_ = false;
};

/// An empty folder of its own for each test, removed at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Whole file as bytes; "" when there is none.
std::string bytes_of(const std::filesystem::path& path);

/// Names of the regular files below a folder, sorted.
std::vector<std::string> files_below(const std::filesystem::path& folder);

}  // namespace varve::test
