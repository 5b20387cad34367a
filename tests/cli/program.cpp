#include "program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace varve::test {
namespace {

std::filesystem::path fresh_path() {
  static std::atomic<int> count = 0;
  return std::filesystem::temp_directory_path() /
         ("varve_cli_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
}

void redirect(const std::filesystem::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(127);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

void obey(const RunLimits& limits) {
  const rlimit memory{limits.memory_mib << 20, limits.memory_mib << 20}, time{limits.seconds, limits.seconds};
  if (limits.memory_mib > 0 && !kSanitized) setrlimit(RLIMIT_AS, &memory);
  if (limits.seconds > 0) setrlimit(RLIMIT_CPU, &time);
}

}  // namespace

Running::Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                 const std::function<void()>& before)
    : out_(fresh_path()), err_(fresh_path()) {
  std::vector<char*> argv;
  std::string program = VARVE_PROGRAM;
  argv.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("fork");
  if (process_ == 0) {
    redirect(out_, STDOUT_FILENO);
    redirect(err_, STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(127);
    if (before) before();
    execv(program.c_str(), argv.data());
    _exit(127);
  }
}

Running::~Running() {
  if (!done_) {
    kill(process_, SIGKILL);
    waitpid(process_, &status_, 0);
  }
  std::filesystem::remove(out_);
  std::filesystem::remove(err_);
}

void Running::send(int signal) const { kill(process_, signal); }

bool Running::stop() {
  if (done_) return false;
  kill(process_, SIGSTOP);
  int status = 0;
  waitpid(process_, &status, WUNTRACED);
  if (WIFSTOPPED(status)) return true;
  done_ = true;
  status_ = status;
  return false;
}

bool Running::finished() {
  if (!done_) done_ = waitpid(process_, &status_, WNOHANG) == process_;
  return done_;
}

Outcome Running::wait() {
  if (!done_) waitpid(process_, &status_, 0);
  done_ = true;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_), bytes_of(out_), bytes_of(err_)};
}

Outcome run_varve(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                  const RunLimits& limits) {
  return Running(arguments, folder, [&] { obey(limits); }).wait();
}

Folder::Folder() : path_(fresh_path()) { std::filesystem::create_directories(path_); }
Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> files_below(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(std::filesystem::relative(entry.path(), folder).string());
  std::ranges::sort(names);
  return names;
}

}  // namespace varve::test
