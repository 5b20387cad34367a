#include "base/process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.h"

namespace varve {
namespace {

/// The streams of the program to be started.
class Streams {
 public:
  explicit Streams(const std::string& messages) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

std::string first_bytes(const std::string& path) {
  std::string text(65536, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));
  return text;
}

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

}  // namespace

ProcessRun run_process(const std::string& program, const std::vector<std::string>& arguments,
                       const std::string& scratch) {
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const Streams streams(scratch);
  const auto start = std::chrono::steady_clock::now();
  pid_t process = -1;
  const int failed = posix_spawn(&process, program.c_str(), streams.get(), nullptr, argv.data(), environ);
  if (failed != 0) throw Failure(ExitCode::output, "'" + program + "' cannot be started: " + std::strerror(failed));
  int status = 0;
  rusage usage{};
  while (wait4(process, &status, 0, &usage) < 0)
    if (errno != EINTR) throw Failure(ExitCode::output, "'" + program + "' was lost: " + std::strerror(errno));

  ProcessRun run;
  run.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_mib = double(usage.ru_maxrss) / 1024;  // Linux counts in KiB
  run.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  run.messages = first_bytes(scratch);
  std::error_code ignored;
  std::filesystem::remove(scratch, ignored);
  return run;
}

}  // namespace varve
