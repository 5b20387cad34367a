#include "signals.h"

#include <unistd.h>
#include <csignal>

namespace varve::cli {
namespace {

// The only state that a handler may touch.
volatile std::sig_atomic_t stop_requested = 0;

extern "C" void on_stop(int signal) {
  if (stop_requested != 0) _exit(128 + signal);
  stop_requested = signal;
}

}  // namespace

void watch_signals() {
  struct sigaction stop = {};
  stop.sa_handler = on_stop;
  stop.sa_flags = SA_RESTART;  // a read or write in flight goes on to its end
  sigemptyset(&stop.sa_mask);
  sigaction(SIGINT, &stop, nullptr);
  sigaction(SIGTERM, &stop, nullptr);
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
}

int stop_signal() { return stop_requested; }

}  // namespace varve::cli
