// Golden numbers: the small real sequence through a few settings.
//   varve_golden SEQUENCE_FOLDER EXPECTED [--renew]
// Prints one line per setting and reference frame: PSNR tone-mapped and linear, and a hash of the resolved halves where
// the arithmetic is plain IEEE (no library functions), so that any change of a bit shows. Exit 1 when the lines differ
// from the committed ones; --renew writes them, and the diff is for a person to read.
#include <unistd.h>

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "exr/read_frame.h"
#include "plan/preset.h"
#include "resolve_sequence.h"
#include "tools/psnr.h"

namespace {

using namespace varve;
namespace fs = std::filesystem;

struct Setting {
  const char* name;
  const char* knobs;  // on top of the preset
  bool plain;         // no library functions: the hash holds on every processor
};

constexpr Setting kSettings[] = {
    {"salvi", "", true},
    {"salvi-ycocg-nearest", "space=ycocg dilation=nearest", true},
    {"bilinear-minmax-clamp", "history-filter=bilinear box=minmax rule=clamp", true},
    {"catmull-rom5-variance-minmax-5x5", "history-filter=catmull-rom5 box=variance-minmax window=5", true},
    {"depth-restart", "disocclusion=depth", true},
    {"tent-samples", "sample-filter=tent", true},
    {"gaussian-samples", "sample-filter=gaussian", false},
};

std::uint64_t hash_pixels(const std::string& path) {
  Workers workers(1);
  const FileHeader header = read_header(path);
  std::vector<ChannelRef> color;
  for (int c = 0; c < int(header.parts[0].channels.size()); ++c)
    if (header.parts[0].channels[std::size_t(c)].name.find("Combined") != std::string::npos) color.push_back({0, 0, c});
  const FramePixels pixels = read_channels(header, color, workers);
  std::uint64_t h = 14695981039346656037ull;
  for (const ChannelRef& ref : color)
    for (int y = 0; y < pixels[ref].rows; ++y)
      for (int i = 0; i < pixels[ref].columns * 2; ++i)
        h = (h ^ std::to_integer<std::uint64_t>(pixels[ref].row(y)[i])) * 1099511628211ull;
  return h;
}

void run(const Setting& setting, const fs::path& sequence, const fs::path& folder, std::ostream& out) {
  ResolveJob job;
  job.input.color = SequencePattern::parse((sequence / "frame.####.exr").string());
  job.output = SequencePattern::parse((folder / "out.####.exr").string());
  job.parameters = preset_parameters(*find_preset("salvi"));
  set_parameters(job.parameters, setting.knobs);
  resolve_sequence(job, {});
  const SequencePattern reference = SequencePattern::parse((sequence / "ref/frame.####.exr").string());
  for (const int frame : reference.frames_on_disk()) {
    tools::Sums sums;
    tools::add_squares(tools::read_rgb(reference.path(frame), "auto"), tools::read_rgb(job.output.path(frame), "auto"),
                       sums);
    char line[160];
    std::snprintf(line, sizeof line, "%-34s frame %2d  tone %.2f  linear %.2f", setting.name, frame,
                  tools::decibels(sums.tone, sums.values), tools::decibels(sums.linear, sums.values));
    out << line;
    if (setting.plain) {
      std::snprintf(line, sizeof line, "  %016" PRIx64, hash_pixels(job.output.path(frame)));
      out << line;
    }
    out << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const fs::path folder = fs::temp_directory_path() / ("varve-golden-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ostringstream lines;
  for (const Setting& setting : kSettings) run(setting, argv[1], folder, lines);
  fs::remove_all(folder);
  if (argc > 3) {
    std::ofstream(argv[2]) << lines.str();
    return 0;
  }
  std::ostringstream expected;
  expected << std::ifstream(argv[2]).rdbuf();
  std::cout << "now:\n" << lines.str() << "committed:\n" << expected.str();
  return lines.str() == expected.str() ? 0 : 1;
}
