#include "signals.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "base/foreign_code.h"

namespace varve::cli {
namespace {

// The only state that a handler may touch: written before the handler is installed, except for the flag.
std::atomic<int> stop_requested = 0;
static_assert(std::atomic<int>::is_always_lock_free);
std::array<int, 8> watched_folders;
std::size_t watched_count = 0;
std::array<char, 32> process_mark;  // "-PID-", as it stands in temporary names

/// ".NAME.varve-HOST-PID-N.tmp", see exr/temporary_file.h.
bool is_own_temporary(const char* name) {
  const std::size_t length = std::strlen(name);
  if (name[0] != '.' || length < 4 || std::strcmp(name + length - 4, ".tmp") != 0) return false;
  const char* mark = std::strstr(name, ".varve-");
  return mark != nullptr && std::strstr(mark, process_mark.data()) != nullptr;
}

/// opendir() may allocate, which a handler must not; the system call below it may be used.
void remove_temporaries(int folder) {
  alignas(8) std::array<char, 8192> entries;
  lseek(folder, 0, SEEK_SET);
  for (;;) {
    const long size = syscall(SYS_getdents64, folder, entries.data(), entries.size());
    if (size <= 0) return;
    for (long at = 0; at < size;) {
      // struct linux_dirent64: inode and offset of 8 bytes each, record length of 2, type of 1, name.
      std::uint16_t length;
      std::memcpy(&length, entries.data() + at + 16, sizeof length);
      const char* name = entries.data() + at + 19;
      if (is_own_temporary(name)) unlinkat(folder, name, 0);
      at += length;
    }
  }
}

extern "C" void on_stop(int signal) {
  if (stop_requested != 0) {
    for (std::size_t i = 0; i < watched_count; ++i) remove_temporaries(watched_folders[i]);
    _exit(128 + signal);
  }
  stop_requested = signal;
}

void say(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody is left to be told
}

extern "C" void on_fault(int signal) {
  if (const char* sentence = foreign_sentence()) {
    say("\nvarve: error: ");
    say(sentence);
    say("\n");
    for (std::size_t i = 0; i < watched_count; ++i) remove_temporaries(watched_folders[i]);
    _exit(int(ExitCode::input));
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace

void watch_faults() {
  struct sigaction fault = {};
  fault.sa_handler = on_fault;
  sigemptyset(&fault.sa_mask);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &fault, nullptr);
}

void watch_signals(std::span<const std::string> folders) {
  std::strncpy(process_mark.data(), ("-" + std::to_string(getpid()) + "-").c_str(), process_mark.size() - 1);
  for (const std::string& folder : folders) {
    if (watched_count == watched_folders.size()) break;
    const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) watched_folders[watched_count++] = descriptor;
  }
  struct sigaction stop = {};
  stop.sa_handler = on_stop;
  stop.sa_flags = SA_RESTART;  // a read or write in flight goes on to its end
  sigemptyset(&stop.sa_mask);
  sigaddset(&stop.sa_mask, SIGINT);
  sigaddset(&stop.sa_mask, SIGTERM);
  sigaction(SIGINT, &stop, nullptr);
  sigaction(SIGTERM, &stop, nullptr);
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);  // a file beyond the limit is a write that fails, with a sentence
}

int stop_signal() { return stop_requested; }

}  // namespace varve::cli
