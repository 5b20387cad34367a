// SIGINT and SIGTERM while frames are being written.
#pragma once

namespace varve::cli {

/// From here on the first SIGINT or SIGTERM only sets a flag; the second ends the program at once, which leaves no file
/// under a final name unfinished because files are renamed when they are complete. A reader of the standard streams
/// that goes away no longer ends the program.
void watch_signals();

/// The signal that asked to stop; 0: none.
int stop_signal();

}  // namespace varve::cli
