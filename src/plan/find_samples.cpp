#include "plan/find_samples.h"

#include <algorithm>

#include "base/error.h"
#include "exr/sample_grid.h"
#include "exr/sample_outputs.h"

namespace varve {
namespace {

void find_grid(FrameHeaders& headers, const RoleRequest& roles) {
  const int n = roles.samples.grid;
  headers.stored = headers.files;
  std::vector<FileHeader> cell;
  std::vector<int> parts;
  for (const FileHeader& file : headers.stored) {
    cell.push_back(header_of_cell(file, n));
    parts.push_back(int(file.parts.size()));
  }
  headers.subjects = subjects_of_cells(find_subjects(cell, roles), parts, n);
  headers.grid = n;
  headers.files.clear();
  for (const FileHeader& file : cell) headers.files.push_back(header_of_cells(file, n));
}

/// How many samples each subject has beside it, itself included, and its place among them.
struct Place {
  int sample = 0, samples = 1;
};

std::vector<Place> places_of(const FrameHeaders& headers, const SampleRequest& request) {
  const std::vector<std::optional<Jitter>> unknown(headers.subjects.size());
  std::vector<Place> places(headers.subjects.size());
  for (const ColorOutput& output : sample_outputs(headers.subjects, request, unknown))
    for (std::size_t s = 0; s < output.inputs.size(); ++s)
      places[output.inputs[s]] = {int(s), int(output.inputs.size())};
  return places;
}

/// Of each subject. A header that is shared by several samples says where none of them lies.
std::vector<std::optional<Jitter>> positions_of(const FrameHeaders& headers, const SampleRequest& request,
                                                const JitterSource& jitter) {
  const std::vector<Place> places = places_of(headers, request);
  std::vector<std::optional<Jitter>> positions;
  for (std::size_t i = 0; i < headers.subjects.size(); ++i) {
    const int part = part_of(headers.subjects[i]);
    const Part& own = headers.files.front().parts[std::size_t(part)];
    const auto [sample, samples] = places[i];
    if (request.grid > 0) {
      const std::optional<Jitter> stored = jitter.by_sample
                                               ? jitter_of_sample(jitter, own, headers.frame, sample, samples)
                                               : jitter_of(jitter, own, headers.frame);
      positions.push_back(jitter_of_cell(stored, sample, headers.grid));
      continue;
    }
    const bool shared = samples > 1 && std::count_if(headers.subjects.begin(), headers.subjects.end(),
                                                     [&](const Subject& other) { return part_of(other) == part; }) > 1;
    if (shared && jitter.kind == JitterSource::Kind::automatic)
      positions.push_back(std::nullopt);
    else
      positions.push_back(jitter_of_sample(with_samples(jitter, samples), own, headers.frame, sample, samples));
  }
  return positions;
}

}  // namespace

void find_samples(FrameHeaders& headers, const RoleRequest& roles, const JitterSource& jitter) {
  const SampleRequest& request = roles.samples;
  if (!roles.channels.empty() && roles.channel_weights == ChannelWeights::own)
    throw Failure(ExitCode::usage,
                  "--samples resolves --channels with their color; give --channel-weights beauty, or leave one of them "
                  "out");
  if (roles.combine_layers.mode != LayersMode::apart)
    throw Failure(
        ExitCode::usage,
        "--samples and --layers cannot be combined: both say how one color is made; resolve the samples of each "
        "layer first, with --layer NAME, then the layers");
  if (request.grid > 0)
    find_grid(headers, roles);
  else
    headers.subjects = find_subjects(headers.files, roles);
  for (std::size_t i = 1; i < headers.subjects.size(); ++i) headers.subjects[i].notes.clear();  // alike
  headers.sample_jitter = positions_of(headers, request, jitter);
  headers.outputs = sample_outputs(headers.subjects, request, headers.sample_jitter);
  check_samples_alike(headers.files.front(), headers.outputs, headers.subjects);
  headers.passed_on = passed_on_of_samples(headers.files.front(), headers.outputs, headers.subjects, request);
  Jitter mean;
  for (const std::optional<Jitter>& position : headers.sample_jitter) {
    if (!position) return;
    mean.x += position->x / double(headers.sample_jitter.size());
    mean.y += position->y / double(headers.sample_jitter.size());
  }
  headers.jitter = mean;
}

FramePixels read_shown_channels(const FrameHeaders& headers, int file, std::span<const ChannelRef> channels,
                                Workers& workers) {
  const FileHeader& shown = headers.files[std::size_t(file)];
  if (headers.stored.empty()) return read_channels(shown, channels, workers);
  return read_cells(headers.stored[std::size_t(file)], shown, channels, headers.grid, workers);
}

}  // namespace varve
