#include "report.h"

#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "resolve_sequence.h"

namespace varve::cli {

void write_report(const std::string& path, std::span<const std::string> rows) {
  std::string text = std::string("{\"version\":\"") + version() + "\",\"frames\":[";
  for (std::size_t i = 0; i < rows.size(); ++i) text += (i > 0 ? ",\n" : "\n") + rows[i];
  text += "\n]}\n";
  write_file(path, text);
}

void write_file(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".tmp" + std::to_string(getpid());
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  bool good = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  int reason = errno;
  if (file && std::fclose(file) != 0 && good) {
    good = false;
    reason = errno;
  }
  if (good && std::rename(temporary.c_str(), path.c_str()) != 0) {
    good = false;
    reason = errno;
  }
  if (good) return;
  std::remove(temporary.c_str());
  throw Failure(ExitCode::output, path + " cannot be written: " + std::strerror(reason));
}

}  // namespace varve::cli
