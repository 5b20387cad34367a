#include "exr/sample_outputs.h"

#include <algorithm>

#include "base/error.h"
#include "exr/channel_index.h"
#include "exr/sample_names.h"

namespace varve {
namespace {

std::string without_number(const std::string& name) {
  const std::optional<SampleName> sample = parse_sample_name(name);
  return sample ? sample->stem : name;
}

double distance(const std::optional<Jitter>& jitter) {
  return jitter ? jitter->x * jitter->x + jitter->y * jitter->y : 0;
}

/// The input that lies nearest to the pixel center; the first where one of them is not known.
std::size_t nearest_input(const ColorOutput& output, std::span<const std::optional<Jitter>> jitter) {
  std::size_t best = output.inputs.front();
  for (const std::size_t input : output.inputs) {
    if (!jitter[input]) return output.inputs.front();
    if (distance(jitter[input]) < distance(jitter[best])) best = input;
  }
  return best;
}

std::string label(const Subject& subject) {
  return subject.layer.empty() ? "the main layer" : "layer " + subject.layer;
}

void describe(ColorOutput& output, const Subject& lender, const SampleRequest& request, bool known) {
  const std::string count = std::to_string(output.inputs.size());
  Subject& s = output.subject;
  s.notes.clear();
  if (request.grid > 0)
    s.notes.push_back("samples: every " + std::to_string(request.grid) + "x" + std::to_string(request.grid) +
                      " pixels of the files are the samples of one, as given; vectors are divided by " +
                      std::to_string(request.grid) +
                      ", and what is not resolved is taken from the pixel nearest to the middle");
  else
    s.notes.push_back(
        "samples: " + count +
        " found by the numbers in their names; they are used up, and what is not "
        "resolved is passed on from " +
        lender.layer +
        (known ? ", which lies nearest to the pixel center" : ", the first, since positions are not known"));
}

}  // namespace

std::vector<ColorOutput> sample_outputs(std::span<const Subject> subjects, const SampleRequest& request,
                                        std::span<const std::optional<Jitter>> jitter) {
  std::vector<ColorOutput> outputs;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const std::string layer = request.grid > 0 ? subjects[i].layer : without_number(subjects[i].layer);
    const auto same = [&](const ColorOutput& o) {
      return o.subject.layer == layer && o.subject.view == subjects[i].view;
    };
    auto output = std::find_if(outputs.begin(), outputs.end(), same);
    if (output == outputs.end()) {
      output = outputs.insert(outputs.end(), ColorOutput{});
      output->subject.layer = layer;
      output->subject.view = subjects[i].view;
    }
    output->inputs.push_back(i);
  }
  for (ColorOutput& output : outputs) {
    const std::string layer = output.subject.layer;
    const Subject& lender = subjects[nearest_input(output, jitter)];
    output.subject = lender;
    output.subject.layer = layer;
    for (std::optional<Channel>& channel : output.subject.place.channels)
      if (channel && request.grid == 0) channel->name = without_number(channel->name);
    if (output.inputs.size() > 1) {
      output.combine = Combine::samples;
      output.after = request.mode == SampleMode::each;
    }
    const bool known = std::all_of(output.inputs.begin(), output.inputs.end(),
                                   [&](std::size_t input) { return jitter[input].has_value(); });
    describe(output, lender, request, known);
  }
  return outputs;
}

PassedOn passed_on_of_samples(const FileHeader& file, std::span<const ColorOutput> outputs,
                              std::span<const Subject> subjects, const SampleRequest& request) {
  PassedOn result;
  const int parts = int(file.parts.size());
  if (request.grid > 0) {
    const int copies = request.grid * request.grid, per_copy = parts / copies;
    const int kept = outputs.front().subject.place.part / per_copy;
    for (int p = 0; p < parts; ++p)
      for (int c = 0; p / per_copy != kept && c < int(file.parts[std::size_t(p)].channels.size()); ++c)
        result.dropped.push_back({0, p, c});
    return result;
  }
  std::vector<int> kept;  // numbers of the samples that lend their data
  for (const ColorOutput& output : outputs)
    for (const std::size_t input : output.inputs)
      if (part_of(subjects[input]) == output.subject.place.part && subjects[input].color == output.subject.color)
        if (const auto name = parse_sample_name(subjects[input].layer)) kept.push_back(name->number);
  for (int p = 0; p < parts; ++p) {
    const Part& part = file.parts[std::size_t(p)];
    const std::optional<SampleName> of_part = parts > 1 ? parse_sample_name(part.name) : std::nullopt;
    for (int c = 0; c < int(part.channels.size()); ++c) {
      const std::string& name = part.channels[std::size_t(c)].name;
      const std::optional<SampleName> of_channel = parse_sample_name(name);
      if (!of_part && !of_channel) continue;
      const int number = of_part ? of_part->number : of_channel->number;
      if (std::find(kept.begin(), kept.end(), number) == kept.end())
        result.dropped.push_back({0, p, c});
      else if (of_channel)
        result.renamed.push_back({{0, p, c}, of_channel->stem});
    }
  }
  return result;
}

void check_samples_alike(const FileHeader& file, std::span<const ColorOutput> outputs,
                         std::span<const Subject> subjects) {
  for (const ColorOutput& output : outputs)
    for (const std::size_t input : output.inputs) {
      const Subject &a = subjects[output.inputs.front()], &b = subjects[input];
      const Part &of_a = file.parts[std::size_t(part_of(a))], &of_b = file.parts[std::size_t(part_of(b))];
      const auto refuse = [&](const std::string& what) {
        throw Failure(ExitCode::inconsistent, file.path + ": the samples " + label(a) + " and " + label(b) +
                                                  " differ " + what +
                                                  "; render them alike, or name one of them with --layer and "
                                                  "leave --samples out");
      };
      if (of_a.data_window != of_b.data_window || of_a.display_window != of_b.display_window)
        refuse("in their windows");
      const auto has = [](const auto& x, const auto& y) { return x.has_value() == y.has_value(); };
      for (std::size_t k = 0; k < 4; ++k)
        if (!has(a.color[k], b.color[k])) refuse(std::string("in the channel ") + "RGBA"[k]);
      if (!has(a.depth, b.depth)) refuse("in having a depth");
      if (!has(a.backward, b.backward) || !has(a.forward, b.forward)) refuse("in having motion vectors");
      if (!has(a.id, b.id) || !has(a.normal, b.normal)) refuse("in having ids or normals");
      const auto same = [&](const Companion& c, const Companion& d) {
        for (std::size_t k = 0; k < 4; ++k)
          if (!has(c.channels[k], d.channels[k])) return false;
        return c.color == d.color;
      };
      if (!std::equal(a.companions.begin(), a.companions.end(), b.companions.begin(), b.companions.end(), same))
        refuse("in the channels that --channels names");
    }
}

}  // namespace varve
