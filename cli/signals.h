// SIGINT and SIGTERM while frames are being written, and libraries that break down.
#pragma once

#include <span>
#include <string>

namespace varve::cli {

/// From here on the first SIGINT or SIGTERM only sets a flag; the second ends the program at once. No file under a
/// final name is then unfinished, because files are renamed when they are complete; the temporary files of this process
/// in `folders` (at most 8 are watched) are removed. A reader of the standard streams that goes away, or a limit
/// on the size of files, no longer ends the program without a word.
void watch_signals(std::span<const std::string> folders);

/// From here on a library that crashes or aborts while it decodes a file (InForeignCode) ends the program with the
/// sentence for it and the exit code of unreadable input, temporary files removed. Faults of our own end it as ever.
void watch_faults();

/// The signal that asked to stop; 0: none.
int stop_signal();

}  // namespace varve::cli
