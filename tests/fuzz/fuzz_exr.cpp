// EXR files, read as probe and resolve read them.
#include <filesystem>
#include <fstream>
#include <string>

#include "exr/camera_source.h"
#include "exr/jitter.h"
#include "exr/read_frame.h"
#include "exr/write_frame.h"
#include "fuzz/scratch.h"
#include "fuzz/targets.h"
#include "plan/describe.h"
#include "plan/preset.h"
#include "plan/resolve_job.h"
#include "resolve_sequence.h"

namespace varve::fuzz {
namespace {

namespace fs = std::filesystem;

/// More would only make each input slow: what is computed from pixels has tests of its own.
constexpr std::uint64_t kPixels = 1 << 18;

ResolveJob job_for(bool deep) {
  ResolveJob job;
  job.input.color = SequencePattern::parse((scratch() / "in.####.exr").string());
  job.output = SequencePattern::parse((scratch() / "out.####.exr").string());
  job.parameters = preset_parameters(*find_preset("salvi"));
  job.threads = 1;
  job.check_motion = !deep;
  return job;
}

std::uint64_t pixels_of(const FileHeader& header) {
  std::uint64_t pixels = 0;
  for (const Part& part : header.parts)
    pixels = std::max({pixels, part.data_window.pixels(), part.display_window.pixels()});
  return pixels;
}

void use(const std::string& path, bool deep) {
  const FileHeader header = read_header(path);
  Workers workers(1);
  std::vector<ChannelRef> flat;
  for (std::size_t p = 0; p < header.parts.size(); ++p)
    for (std::size_t c = 0; !is_deep(header.parts[p]) && c < header.parts[p].channels.size(); ++c)
      flat.push_back({0, int(p), int(c)});
  // Each alone, so that a refusal of one does not hide the others.
  taken_or_refused([&] { read_channels(header, flat, workers); });
  taken_or_refused([&] {
    std::vector<OutputPart> parts(header.parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) parts[p].source_part = int(p), parts[p].copy_chunks = true;
    write_frame((scratch() / "copy.exr").string(), header, parts, {}, workers);
  });
  ResolveJob job = job_for(deep);
  taken_or_refused([&] {
    const SequenceInfo info = probe_sequence(job.input, {}, job.roles, {}, {});
    const Plan plan = make_plan(info, job.parameters, job.request, 1);
    if (pixels_of(header) > kPixels) return;
    const auto statistics = measure_pixels(info, job.input, job.roles, {}, 1, workers);
    describe_text(info, plan, statistics);
    describe_json(info, plan, statistics);
  });
  if (pixels_of(header) > kPixels) return;
  if (taken_or_refused([&] { resolve_sequence(job, {}); })) return;
  job.roles.convention = "none";  // what has no vectors, or ones that nobody knows, has pixels all the same
  taken_or_refused([&] { resolve_sequence(job, {}); });
}

int run(const std::uint8_t* data, std::size_t size, bool deep) {
  // Two frames of the same bytes, so that vectors lead somewhere.
  const fs::path first = scratch() / "in.0001.exr", second = scratch() / "in.0002.exr";
  std::error_code ignored;
  fs::remove(second, ignored);
  std::ofstream(first, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), std::streamsize(size));
  fs::create_hard_link(first, second, ignored);
  taken_or_refused([&] { use(first.string(), deep); });
  return 0;
}

}  // namespace

int fuzz_exr(const std::uint8_t* data, std::size_t size) { return run(data, size, false); }
int fuzz_deep(const std::uint8_t* data, std::size_t size) { return run(data, size, true); }

}  // namespace varve::fuzz
