// Fuzzing that any compiler builds and that does the same each time: the seeds of a target, then so many inputs made
// from them. Each runs in a child with limits of memory and time, so that a crash, a hang and a huge allocation are
// counted and the rest goes on.
//   varve_fuzz TARGET [--count N] [--first N] [--memory MIB, 0: any] [--seconds N] [--keep FOLDER]
//   varve_fuzz TARGET --header-bytes          each byte of the headers of a few files, one at a time
//   varve_fuzz TARGET --write-seeds FOLDER
//   varve_fuzz TARGET FILE...                 runs these files
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fuzz/scratch.h"
#include "fuzz/targets.h"
#include "support/exr_shape.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VARVE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define VARVE_SANITIZED 1
#endif
#endif

namespace {

using namespace varve::fuzz;

struct Settings {
  const Target* target = nullptr;
  std::uint64_t first = 0, count = 1000;
  std::size_t memory_mib = 1024;
  int seconds = 10;  ///< of the processor, for one input
  std::string keep = ".", seeds;
  bool header_bytes = false;
  std::vector<std::string> files;
};

/// What the child tells the parent, in shared memory.
struct Report {
  std::uint64_t next = 0;  ///< the input at work
  Tally tally;
  double slowest = 0;
  std::uint64_t slowest_input = 0;
  long most_kib = 0;
  std::uint64_t most_input = 0;
};

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The seeds come first, then what is made of them, each by its number alone.
std::string input_of(const Target& target, const std::vector<std::string>& seeds, std::uint64_t number) {
  if (number < seeds.size()) return seeds[number];
  Random random(number * 0x9E3779B97F4A7C15u);
  std::string bytes = seeds[random() % seeds.size()];
  return target.mutate(bytes, random);
}

/// Peak memory since the last reset; Linux only, else that of the whole process.
void reset_peak() {
  if (std::FILE* file = std::fopen("/proc/self/clear_refs", "w")) {
    std::fputs("5", file);
    std::fclose(file);
  }
}

long peak_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::strtol(line.c_str() + 6, nullptr, 10);
  return 0;
}

void limit(const Settings& settings) {
#ifndef VARVE_SANITIZED  // their shadow memory is larger than any machine
  const rlimit memory{settings.memory_mib << 20, settings.memory_mib << 20};
  if (settings.memory_mib > 0) setrlimit(RLIMIT_AS, &memory);
#endif
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

/// Time of the processor, since machines are shared; and ten times that on the wall, for what waits forever.
void watch(int seconds) {
  const itimerval processor{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &processor, nullptr);
  alarm(unsigned(10 * seconds));
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void work(const Settings& settings, const std::vector<std::string>& seeds, std::uint64_t end, Report& report) {
  limit(settings);
  for (; report.next < end; ++report.next) {
    const std::string input = input_of(*settings.target, seeds, report.next);
    watch(settings.seconds);
    reset_peak();
    const double begin = processor_seconds();
    const Tally before = tally();
    settings.target->run(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    const double seconds = processor_seconds() - begin;
    if (seconds > report.slowest) report.slowest = seconds, report.slowest_input = report.next;
    const long kib = peak_kib();
    if (kib > report.most_kib) report.most_kib = kib, report.most_input = report.next;
    report.tally.taken += tally().taken - before.taken;
    report.tally.refused += tally().refused - before.refused;
  }
}

/// Runs inputs up to `end` in children until all had their turn. Returns how many ended a child.
int run_all(const Settings& settings, const std::vector<std::string>& seeds, std::uint64_t end) {
  auto* report =
      static_cast<Report*>(mmap(nullptr, sizeof(Report), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  if (report == MAP_FAILED) return 1;
  report->next = settings.first;
  int bad = 0;
  while (report->next < end) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
      work(settings, seeds, end, *report);
      std::exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    std::error_code ignored;
    std::filesystem::remove_all(scratch().parent_path() / ("varve-fuzz-" + std::to_string(child)), ignored);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
    ++bad;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    const std::string name =
        settings.keep + "/" + std::string(settings.target->name) + "-" + std::to_string(report->next) + ".bad";
    std::ofstream(name, std::ios::binary) << input_of(*settings.target, seeds, report->next);
    std::printf("%s: input %llu %s (signal %d, exit %d); kept as %s\n", std::string(settings.target->name).c_str(),
                static_cast<unsigned long long>(report->next),
                signal == SIGPROF || signal == SIGALRM ? "hangs" : "crashes", signal,
                WIFEXITED(status) ? WEXITSTATUS(status) : -1, name.c_str());
    ++report->next;
  }
  std::printf(
      "%-10s %llu inputs, %d bad; %llu readings taken, %llu refused; slowest %.3f s of processor (input %llu), "
      "most memory %ld MiB (input %llu)\n",
      std::string(settings.target->name).c_str(), static_cast<unsigned long long>(end - settings.first), bad,
      static_cast<unsigned long long>(report->tally.taken), static_cast<unsigned long long>(report->tally.refused),
      report->slowest, static_cast<unsigned long long>(report->slowest_input), report->most_kib / 1024,
      static_cast<unsigned long long>(report->most_input));
  munmap(report, sizeof(Report));
  return bad;
}

int write_seeds(const Settings& settings) {
  std::filesystem::create_directories(settings.seeds);
  int number = 0;
  for (const std::string& seed : settings.target->seeds())
    std::ofstream(settings.seeds + "/seed" + std::to_string(number++), std::ios::binary) << seed;
  return 0;
}

/// One input for each byte of the headers and chunk tables.
std::vector<std::string> flipped_header_bytes() {
  std::vector<std::string> inputs;
  for (const NamedSeed& seed : named_seeds()) {
    const std::size_t reach = varve::test::exr_shape(seed.bytes).data_at;
    for (std::size_t at = 0; at < reach; ++at) {
      inputs.push_back(seed.bytes);
      inputs.back()[at] = char(inputs.back()[at] ^ (at % 3 == 0 ? 0x80 : at % 3 == 1 ? 0x01 : 0x54));
    }
  }
  return inputs;
}

Settings read(int argc, char** argv) {
  Settings settings;
  settings.target = argc > 1 ? find_target(argv[1]) : nullptr;
  for (int i = 2; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto number = [&] { return std::strtoull(argv[++i], nullptr, 10); };
    if (argument == "--header-bytes")
      settings.header_bytes = true;
    else if (argument == "--count" && i + 1 < argc)
      settings.count = number();
    else if (argument == "--first" && i + 1 < argc)
      settings.first = number();
    else if (argument == "--memory" && i + 1 < argc)
      settings.memory_mib = number();
    else if (argument == "--seconds" && i + 1 < argc)
      settings.seconds = int(number());
    else if (argument == "--keep" && i + 1 < argc)
      settings.keep = argv[++i];
    else if (argument == "--write-seeds" && i + 1 < argc)
      settings.seeds = argv[++i];
    else
      settings.files.push_back(argument);
  }
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = read(argc, argv);
  if (!settings.target) {
    std::fputs(
        "varve_fuzz TARGET [--count N] [--first N] [--memory MIB] [--seconds N] [--keep FOLDER] "
        "[--write-seeds FOLDER] [FILE...]\ntargets:",
        stderr);
    for (const Target& target : targets()) std::fprintf(stderr, " %s", std::string(target.name).c_str());
    std::fputc('\n', stderr);
    return 2;
  }
  if (!settings.seeds.empty()) return write_seeds(settings);
  if (settings.header_bytes) {
    const std::vector<std::string> inputs = flipped_header_bytes();
    return run_all(settings, inputs, inputs.size()) > 0 ? 1 : 0;
  }
  if (!settings.files.empty()) {
    std::vector<std::string> inputs;
    for (const std::string& file : settings.files) inputs.push_back(bytes_of(file));
    return run_all(settings, inputs, inputs.size()) > 0 ? 1 : 0;
  }
  const std::vector<std::string> seeds = settings.target->seeds();
  const std::uint64_t end = settings.first + settings.count + (settings.first == 0 ? seeds.size() : 0);
  return run_all(settings, seeds, end) > 0 ? 1 : 0;
}
