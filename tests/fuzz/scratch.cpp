#include "fuzz/scratch.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace varve::fuzz {
namespace {

namespace fs = std::filesystem;

struct Scratch {
  fs::path folder;
  Scratch() {
    std::error_code ignored;
    const char* asked = std::getenv("VARVE_FUZZ_FOLDER");
    const fs::path shm = asked ? asked : "/dev/shm";
    folder = (fs::is_directory(shm, ignored) ? shm : fs::temp_directory_path()) /
             ("varve-fuzz-" + std::to_string(::getpid()));
    fs::create_directories(folder);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
};

}  // namespace

const fs::path& scratch() {
  static const Scratch made;
  return made.folder;
}

}  // namespace varve::fuzz
