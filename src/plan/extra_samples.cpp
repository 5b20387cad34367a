#include "plan/extra_samples.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/json.h"
#include "exr/sample_names.h"
#include "plan/extra_files.h"
#include "plan/find_samples.h"

namespace varve {
namespace {

constexpr const char* kRenderAlike = "; render it with the passes of the frames, or leave it out of --extra";

std::string text_of(const Window& w) {
  return std::to_string(w.x0) + "," + std::to_string(w.y0) + "-" + std::to_string(w.x1 - 1) + "," +
         std::to_string(w.y1 - 1);
}

std::string size_of(const Window& w) { return std::to_string(w.width()) + "x" + std::to_string(w.height()); }

Window moved(const Window& w, int x, int y) { return {w.x0 + x, w.y0 + y, w.x1 + x, w.y1 + y}; }

const Part& part_of_output(const FrameHeaders& headers, const ColorOutput& output) {
  return headers.files.front().parts[std::size_t(part_of(headers.subjects[output.inputs.front()]))];
}

/// Whether the file has samples side by side.
bool has_numbers(const FileHeader& file) {
  for (const Part& part : file.parts) {
    if (file.parts.size() > 1 && parse_sample_name(part.name)) return true;
    for (const Channel& channel : part.channels)
      if (parse_sample_name(channel.name)) return true;
  }
  return false;
}

void check_job(const ResolveJob& job, const SequenceInfo& info) {
  const auto refuse = [](const char* what) { throw Failure(ExitCode::usage, what); };
  const SampleRequest& samples = job.roles.samples;
  const bool gathers = job.parameters.accumulator == Accumulator::gather;
  const bool places = gathers || job.parameters.accumulator == Accumulator::subpixel;  // each sample where it lies
  if (job.roles.combine_layers.mode != LayersMode::apart)
    refuse(
        "--extra adds samples to one color, and --layers makes it of several; resolve each layer with its own "
        "--extra first, then the layers");
  if (samples.mode != SampleMode::off && (samples.grid > 0 || samples.mode != SampleMode::each || !places))
    refuse(
        "with --samples, --extra needs each sample for itself; give --samples each --accumulator gather, or leave "
        "--samples out and name the further samples with --extra");
  if (!job.roles.channels.empty() && job.roles.channel_weights == ChannelWeights::own)
    refuse("--extra adds samples to the colors of the frames; give --channel-weights beauty, or leave --channels out");
  if (!job.roles.channels.empty() && !places && job.parameters.recursive.sample_filter != SampleFilter::none)
    refuse(
        "--channels are not reconstructed from samples of --extra; give --sample-filter none, --accumulator gather, "
        "or leave --channels out");
  if (!job.input.roles.empty())
    refuse("--extra takes depth and vectors from the files of the colors; leave --depth-file and --motion-file out");
  if (job.parameters.recursive.unjitter != Unjitter::none && !places)
    refuse(
        "--unjitter moves all samples of a frame alike, and those of --extra lie elsewhere; give --sample-filter "
        "gaussian and --unjitter none");
  if (gathers && job.parameters.repair.mode == RepairMotion::on)
    refuse(
        "the vectors of --extra are taken as they are, and --repair-motion on would not repair them; give "
        "--repair-motion off, or --accumulator two-sided");
  for (const Subject& subject : info.first.subjects)
    if (is_deep(info.first.files.front().parts[std::size_t(part_of(subject))]))
      refuse("--extra adds samples to flat colors, and this one is deep; flatten it first, with varve resolve");
}

/// Why a color of the file cannot add to one of the frame; "" if it can. It may have more than the frame.
std::string misfit(const Subject& frame, const Subject& extra) {
  const auto differ = [](const auto& a, const auto& b) { return a.has_value() != b.has_value(); };
  for (std::size_t k = 0; k < 4; ++k)
    if (differ(frame.color[k], extra.color[k])) return std::string("its channels differ in ") + "RGBA"[k];
  const auto lacks = [](const auto& a, const auto& b) { return a.has_value() && !b.has_value(); };
  if (lacks(frame.depth, extra.depth)) return "it has no depth";
  if (lacks(frame.backward, extra.backward) || lacks(frame.forward, extra.forward))
    return "it lacks vectors that the frame has";
  if (lacks(frame.id, extra.id)) return "it has no id";
  if (lacks(frame.normal, extra.normal)) return "it has no normal";
  if (lacks(frame.reactive, extra.reactive) || lacks(frame.responsive, extra.responsive)) return "it has no mask";
  const auto same = [&](const Companion& c, const Companion& d) {
    for (std::size_t k = 0; k < 4; ++k)
      if (differ(c.channels[k], d.channels[k])) return false;
    return c.color == d.color;
  };
  if (!std::equal(frame.companions.begin(), frame.companions.end(), extra.companions.begin(), extra.companions.end(),
                  same))
    return "what --channels names differs";
  return "";
}

/// The member `window` of Cycles' note.
std::optional<std::array<int, 4>> window_in_note(const Part& part) {
  const Attribute* attribute = part.attribute("Note");
  const std::optional<JsonValue> note = attribute ? parse_json(attribute->text) : std::nullopt;
  const JsonValue* member = note ? note->find("window") : nullptr;
  const std::optional<std::vector<double>> n = member ? member->numbers() : std::nullopt;
  if (!n || n->size() != 4) return std::nullopt;
  std::array<int, 4> window{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (!((*n)[k] >= -1e9 && (*n)[k] <= 1e9)) return std::nullopt;
    window[k] = int((*n)[k]);
  }
  return window;
}

/// Takes one frame's files apart.
struct ExtraReader {
  const ResolveJob& job;
  const FrameHeaders& frame;
  const std::map<std::string, ListedExtra>& listed;
  bool jitter_known;
  ExtraSamples& out;

  [[noreturn]] void refuse(const std::string& path, const std::string& why) const {
    throw Failure(ExitCode::inconsistent, "frame " + std::to_string(frame.frame) + ", '" + path + "': " + why);
  }

  void add(const std::string& path) {
    const FrameHeaders extra = read_extra_headers(path, frame.frame, job.roles, job.jitter != "none");
    const auto known = listed.find(std::filesystem::path(path).filename().string());
    check_alike(path, extra);
    const Part& part = part_of_output(extra, extra.outputs.front());
    ExtraCrop crop = place(path, part, known == listed.end() ? nullptr : &known->second);
    const std::size_t samples = extra.outputs.front().inputs.size();
    for (std::size_t s = 0; s < samples; ++s) {
      crop.place = s;
      crop.jitter = extra.sample_jitter[extra.outputs.front().inputs[s]];
      if (known != listed.end() && known->second.jitter && samples == 1) crop.jitter = known->second.jitter;
      if (job.jitter == "none") crop.jitter.reset();
      if (!crop.jitter && jitter_known)
        refuse(path,
               "where in its pixel it was sampled is not known; write it as the attribute jitter, give the list "
               "of renders with --extra-list, or --jitter none");
      out.frames[frame.frame].push_back(crop);
    }
  }

  void check_alike(const std::string& path, const FrameHeaders& extra) const {
    for (const ColorOutput& output : frame.outputs) {
      const auto same = [&](const ColorOutput& o) {
        return o.subject.layer == output.subject.layer && o.subject.view == output.subject.view;
      };
      const auto found = std::find_if(extra.outputs.begin(), extra.outputs.end(), same);
      const std::string layer =
          output.subject.layer.empty() ? "the main layer" : "layer '" + output.subject.layer + "'";
      if (found == extra.outputs.end())
        refuse(path, "has no " + layer.substr(layer.starts_with("the ") ? 4 : 0) + kRenderAlike);
      const std::string why = misfit(frame.subjects[output.inputs.front()], extra.subjects[found->inputs.front()]);
      if (!why.empty()) refuse(path, "does not fit " + layer + " of the frame: " + why + kRenderAlike);
      if (found->inputs.size() != extra.outputs.front().inputs.size())
        refuse(path, "has more samples of one layer than of another" + std::string(kRenderAlike));
      if (part_of_output(extra, *found).data_window != part_of_output(extra, extra.outputs.front()).data_window)
        refuse(path, "its layers have different data windows" + std::string(kRenderAlike));
    }
  }

  /// Where its pixels belong.
  ExtraCrop place(const std::string& path, const Part& part, const ListedExtra* listing) {
    const Part& own = part_of_output(frame, frame.outputs.front());
    const Window &display = own.display_window, &data = own.data_window;
    ExtraCrop crop;
    crop.path = path;
    crop.window = part.data_window;
    std::optional<std::array<int, 4>> told = window_in_note(part);
    if (listing) told = listing->window;
    std::optional<Window> window;
    if (told) window = moved({(*told)[0], (*told)[1], (*told)[2], (*told)[3]}, display.x0, display.y0);
    const bool cut_off = part.display_window != display;
    if (cut_off && window && size_of(*window) == size_of(part.data_window) && !window->empty()) {
      crop.shift_x = window->x0 - part.data_window.x0, crop.shift_y = window->y0 - part.data_window.y0;
      crop.window = *window;
    } else if (cut_off) {
      refuse(path, "its display window has " + size_of(part.display_window) + " pixels at " +
                       text_of(part.display_window) + ", that of the frame " + size_of(display) + " at " +
                       text_of(display) +
                       "; render crops with the display window of the frames, or tell where they lie with "
                       "--extra-list");
    } else if (window) {
      crop.window = intersect(crop.window, *window);
    }
    const Window inside = intersect(crop.window, data);
    if (inside.empty())
      refuse(path, "its window " + text_of(crop.window) + " lies outside of the frame's data window " + text_of(data) +
                       "; render it within the frame, or leave it out of --extra");
    const std::size_t beyond = crop.window.pixels() - inside.pixels();
    if (beyond > 0)
      out.warnings.push_back("frame " + std::to_string(frame.frame) + ", '" + path + "': " + std::to_string(beyond) +
                             " of " + std::to_string(crop.window.pixels()) + " pixels of its window " +
                             text_of(crop.window) + " lie outside of the frame's data window " + text_of(data) +
                             " and are left out");
    crop.window = inside;
    crop.whole = inside == data;
    return crop;
  }
};

}  // namespace

FrameHeaders read_extra_headers(const std::string& path, int frame, const RoleRequest& roles, bool use_jitter) {
  FrameHeaders headers;
  headers.frame = frame;
  headers.files.push_back(read_header(path));
  RoleRequest own = roles;
  own.samples = {has_numbers(headers.files.front()) ? SampleMode::each : SampleMode::off, 0};
  JitterSource jitter;
  if (!use_jitter) jitter.kind = JitterSource::Kind::none;
  try {
    if (own.samples.mode == SampleMode::each) {
      find_samples(headers, own, jitter);
    } else {
      headers.subjects = find_subjects(headers.files, own);
      headers.outputs = color_outputs(headers.files, headers.subjects, own);
      for (const Subject& subject : headers.subjects)
        headers.sample_jitter.push_back(
            jitter_of(jitter, headers.files.front().parts[std::size_t(part_of(subject))], frame));
    }
  } catch (const Failure& failure) {
    throw Failure(failure.code(), "frame " + std::to_string(frame) + ", '" + path + "' (--extra): " + failure.what());
  }
  return headers;
}

ExtraSamples find_extra_samples(const ResolveJob& job, const SequenceInfo& info, const JitterSource& jitter,
                                const std::vector<int>& frames) {
  ExtraSamples out;
  if (job.extra.empty()) {
    if (!job.extra_list.empty())
      throw Failure(ExitCode::usage, "--extra-list tells where the files of --extra lie; give --extra with it");
    return out;
  }
  check_job(job, info);
  std::map<std::string, ListedExtra> listed;
  if (!job.extra_list.empty()) listed = read_extra_list(job.extra_list);
  const std::map<int, std::vector<std::string>> files = find_extra_files(job.extra, frames);
  std::size_t count = 0;
  for (const auto& [frame, paths] : files) {
    const FrameHeaders headers = read_frame_headers(job.input, frame, job.roles, jitter);
    ExtraReader reader{job, headers, listed, headers.jitter.has_value(), out};
    for (const std::string& path : paths) reader.add(path);
    count += paths.size();
  }
  std::vector<int> with;
  for (const auto& [frame, paths] : files) with.push_back(frame);
  const std::size_t without = frames.size() - with.size();
  out.notes.push_back(count == 0
                          ? "extra samples: no file of --extra is there for any frame"
                          : "extra samples: " + std::to_string(count) + " files for frames " + format_frame_list(with) +
                                (without > 0 ? ", none for " + std::to_string(without) + " others" : ""));
  if (count == 0 || without > 0) out.warnings.push_back(out.notes.back());
  return out;
}

std::string extra_files_text(const ExtraSamples& extras, int frame) {
  std::string text, last;
  const auto found = extras.frames.find(frame);
  if (found == extras.frames.end()) return text;
  for (const ExtraCrop& crop : found->second) {
    if (crop.path == last) continue;
    last = crop.path;
    text += (text.empty() ? "" : ",") + std::filesystem::path(crop.path).filename().string();
  }
  return text;
}

}  // namespace varve
