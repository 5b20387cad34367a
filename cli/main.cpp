// The program: runs the command line and turns whatever goes wrong into one sentence and an exit code.
#include <malloc.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/printable.h"
#include "commands.h"
#include "signals.h"

namespace {

/// Planes and codec state are allocated again for every frame. glibc would map and unmap them each time, and every page
/// would be faulted in anew; 32 MiB is the greatest threshold it takes.
void keep_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 512 << 20);
  mallopt(M_TOP_PAD, 16 << 20);
#endif
}

int fail(varve::ExitCode code, const std::string& sentence) {
  std::fputs(("varve: error: " + varve::printable(sentence) + "\n").c_str(), stderr);
  return int(code);
}

bool reader_is_gone() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

/// A full disk shows only here, and what was longer than the buffer has met it before: of that only the mark of the
/// stream is left. A reader that went away wanted no more: a quiet end.
int flush_output(int code) {
  const bool failed_before = std::ferror(stdout) != 0, failed_now = std::fflush(stdout) != 0;
  const int reason = failed_now ? errno : 0;
  if ((!failed_before && !failed_now) || reason == EPIPE || reader_is_gone()) return code;
  return fail(varve::ExitCode::output, std::string("standard output cannot be written: ") +
                                           (failed_now ? std::strerror(reason) : "it did not take all of the text"));
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they report faults themselves
  varve::cli::watch_faults();
#endif
  try {
    return flush_output(varve::cli::run(std::vector<std::string>(argv + (argc > 0), argv + argc)));
  } catch (const varve::Failure& failure) {
    return fail(failure.code(), failure.what());
  } catch (const std::bad_alloc&) {
    return fail(varve::ExitCode::input,
                "memory ran out; resolve fewer layers at once with --layer, or use a machine with more memory");
  } catch (const std::exception& exception) {
    return fail(varve::ExitCode::self_check, std::string("something happened that the program does not expect (") +
                                                 exception.what() + "); please report it with the command line");
  }
}
