#include "stages/wait_for_frames.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <map>
#include <vector>

#include "base/error.h"
#include "exr/file_header.h"
#include "exr/file_print.h"
#include "plan/value.h"

namespace varve {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLookEvery = 250;    // ms
constexpr std::int64_t kRest = 2;  // s without a change: its writer is done with it

/// A file that is waited for.
struct Awaited {
  int frame = 0;
  std::string path;
  FileIdentity seen;
};

bool rests(const FileIdentity& now, const FileIdentity& before) {
  const std::int64_t age = std::int64_t(std::time(nullptr)) - now.seconds;
  return now == before || age > kRest;
}

/// Empty when it can be read; else what it lacks. `changed` tells that something has happened to it.
std::string lack_of(Awaited& file, bool& changed) {
  const FileIdentity now = identity_of(file.path);
  const bool settled = rests(now, file.seen);
  changed = changed || now != file.seen;
  file.seen = now;
  if (!now.there) return "is not there yet";
  return settled && has_every_chunk(file.path) ? "" : "is not complete yet";
}

std::vector<Awaited> files_of(const ResolveJob& job) {
  std::vector<Awaited> files;
  for (const int frame : job.frames) {
    files.push_back({frame, job.input.color.path(frame), {}});
    for (const SequencePattern& role : job.input.roles) files.push_back({frame, role.path(frame), {}});
  }
  return files;
}

}  // namespace

void wait_for_frames(const ResolveJob& job, const std::function<void(const std::string&)>& tell,
                     const std::function<bool()>& stop) {
  if (!(job.wait_seconds > 0)) return;
  if (job.frames.empty() && job.input.color.has_frame())
    throw Failure(ExitCode::usage,
                  "--wait needs --frames: frames that are not there yet cannot be found by themselves");
  std::vector<Awaited> awaited = files_of(job);
  const std::size_t all = awaited.size();
  std::string told;
  for (Clock::time_point since = Clock::now(); !stop();) {
    bool changed = false;
    std::string lack;  // of the first that lacks something
    std::vector<Awaited> left;
    for (Awaited& file : awaited) {
      const std::string of_this = lack_of(file, changed);
      if (of_this.empty()) continue;
      if (lack.empty()) lack = "frame " + std::to_string(file.frame) + ": '" + file.path + "' " + of_this;
      left.push_back(std::move(file));
    }
    awaited = std::move(left);
    if (awaited.empty()) return;
    if (changed) since = Clock::now();
    const std::string text = "waits for " + lack + "; " + std::to_string(all - awaited.size()) + " of " +
                             std::to_string(all) + " files are ready";
    if (tell && text != told) tell(text);
    told = text;
    if (std::chrono::duration<double>(Clock::now() - since).count() > job.wait_seconds)
      throw Failure(ExitCode::input, lack + ", and nothing has changed for " + short_number(job.wait_seconds) +
                                         " s (--wait); render it, wait longer, or leave it out with --frames");
    ::poll(nullptr, 0, kLookEvery);
  }
}

}  // namespace varve
