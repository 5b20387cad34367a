#include "synth_sequence.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <list>
#include <system_error>

#include "base/error.h"
#include "base/json.h"
#include "exr/convert.h"
#include "exr/jitter.h"
#include "exr/new_file.h"
#include "exr/output_bytes.h"
#include "exr/sequence.h"
#include "synth/hash.h"
#include "synth/render.h"
#include "synth/scenes.h"

namespace varve {
namespace {

using synth::Layer;
using synth::Moment;

constexpr int kZipLevel = 4;
constexpr std::uint64_t kTruthKey = 1000, kYardstickKey = 2000;  // so that no two renders share their chance

struct LayerName {
  Layer layer;
  const char* name;
};
constexpr std::array<LayerName, 3> kLayers = {
    {{Layer::foreground, "fg"}, {Layer::middle, "mid"}, {Layer::background, "bg"}}};

/// Channels of one part; owns their pixels.
struct ChannelStore {
  std::list<RawPlane> planes;
  std::vector<OutputChannel> channels;

  void add(const std::string& name, const Plane<float>& from, PixelType type) {
    RawPlane plane = make_raw_plane(type, from.window());
    for (int y = 0; y < plane.rows; ++y) {
      const float* row = from.row(from.window().y0 + y);
      if (type == PixelType::float16)
        to_half_clamped(row, reinterpret_cast<std::uint16_t*>(plane.row(y)), std::size_t(plane.columns));
      else
        std::memcpy(plane.row(y), row, std::size_t(plane.columns) * sizeof(float));
    }
    keep(name, std::move(plane));
  }
  void add(const std::string& name, const Plane<std::uint32_t>& from) {
    RawPlane plane = make_raw_plane(PixelType::uint32, from.window());
    for (int y = 0; y < plane.rows; ++y)
      std::memcpy(plane.row(y), from.row(from.window().y0 + y), std::size_t(plane.columns) * sizeof(std::uint32_t));
    keep(name, std::move(plane));
  }

 private:
  void keep(const std::string& name, RawPlane plane) {
    planes.push_back(std::move(plane));
    channels.push_back({{name, planes.back().type}, &planes.back()});
  }
};

void add_picture(ChannelStore& store, const std::string& layer, const synth::Picture& picture, PixelType type) {
  const std::string before = layer.empty() ? "" : layer + ".";
  store.add(before + "R", picture.r, type);
  store.add(before + "G", picture.g, type);
  store.add(before + "B", picture.b, type);
  store.add(before + "A", picture.a, type);
  store.add(before + "Z", picture.depth, PixelType::float32);
  store.add(before + "velocity.x", picture.backward_x, PixelType::float32);
  store.add(before + "velocity.y", picture.backward_y, PixelType::float32);
  store.add(before + "forward.x", picture.forward_x, PixelType::float32);
  store.add(before + "forward.y", picture.forward_y, PixelType::float32);
  store.add(before + "id", picture.id);
}

/// Everything that stays the same from frame to frame.
struct Synth {
  const SynthJob& job;
  synth::Scene scene;
  Window window;
  JitterSource jitter;
  JitterSource samples;  ///< the same with so many positions for each frame
  Workers workers;

  explicit Synth(const SynthJob& given)
      : job(given),
        scene(synth::make_scene(given.scene)),
        jitter(parse_jitter_source(given.jitter)),
        samples(with_samples(jitter, given.samples)),
        workers(given.threads) {
    window = {0, 0, job.width > 0 ? job.width : scene.width, job.height > 0 ? job.height : scene.height};
  }

  Moment moment(int frame, std::optional<Layer> layer = std::nullopt) const {
    return synth::moment_of(scene, frame, window.width(), window.height(), layer);
  }
  std::uint64_t key(int frame, std::uint64_t purpose) const {
    const std::uint64_t seed = synth::mix(std::uint64_t(std::int64_t(job.seed)), purpose);
    return synth::mix(seed, std::uint64_t(std::int64_t(frame)));
  }
  std::string path(const std::string& below, int frame) const {
    const std::filesystem::path folder = std::filesystem::path(job.folder) / below;
    return SequencePattern::parse((folder / (job.scene + ".####.exr")).string()).path(frame);
  }
};

void check(const SynthJob& job, const Synth& synth) {
  if (job.jitter == "auto" || job.jitter == "pixels")
    throw Failure(ExitCode::usage,
                  "--jitter " + job.jitter + ": there is no header to read yet; give none, halton23:16 or a CSV file");
  if (job.layers && job.samples > 1)
    throw Failure(ExitCode::usage, "--layers and --samples cannot be combined; ask for one of them");
  if (job.samples > 1 && synth.jitter.kind == JitterSource::Kind::table)
    throw Failure(ExitCode::usage,
                  "--jitter " + job.jitter + ": a file has one position for each frame, and --samples " +
                      std::to_string(job.samples) + " needs more; give a sequence such as halton23:16");
  // All samples of a frame are held until it is written, some 70 bytes each.
  constexpr std::size_t kMostSamples = std::size_t(1) << 27;
  if (synth.window.pixels() * std::size_t(job.samples) * (job.layers ? 4 : 1) > kMostSamples)
    throw Failure(ExitCode::usage,
                  "a picture of this size with this many samples or layers would need more than 9 GiB of memory; make "
                  "--size or --samples smaller");
  bool several = false;
  for (const synth::Shot& shot : synth.scene.shots)
    for (const synth::Surface& surface : shot.surfaces) several = several || surface.layer != Layer::background;
  if (job.layers && !several)
    throw Failure(ExitCode::inconsistent,
                  "the scene " + job.scene + " has one layer only; --layers is for scenes such as panes and crossing");
}

// Through memory, because GCC 12 drops the rounding of double(float(x)) where it vectorizes a pair of them.
double as_float(double value) {
  volatile float stored = float(value);
  return double(stored);
}

// Rounded to float, which is what the attribute holds, so that file, table and sample agree to the last bit.
glm::dvec2 jitter_at(const Synth& synth, int frame, int sample) {
  int index = frame;
  if (synth.jitter.kind == JitterSource::Kind::pattern) {
    const auto length = std::int64_t(synth.jitter.points.size());
    index = int((std::int64_t(frame) - 1) % length) * synth.job.samples + sample + 1;
  }
  const std::optional<Jitter> found = jitter_of(synth.samples, Part{}, index);
  if (!found && synth.samples.kind == JitterSource::Kind::table)
    throw Failure(ExitCode::inconsistent, synth.job.jitter + " has no jitter for frame " + std::to_string(frame) +
                                              "; add it or choose --frames");
  const Jitter jitter = found.value_or(Jitter{});
  return {as_float(jitter.x), as_float(jitter.y)};
}

std::vector<double> numbers_of(const synth::Matrix& matrix) {
  return {std::begin(matrix.values), std::end(matrix.values)};
}

std::string json_matrix(const synth::Matrix& matrix) {
  std::string text;
  for (const double value : matrix.values) text += (text.empty() ? "[" : ",") + json_number(value);
  return text + "]";
}

std::vector<Attribute> attributes_of(const Synth& synth, const Moment& moment) {
  const synth::Camera& camera = moment.camera;
  const int width = synth.window.width(), height = synth.window.height();
  const SynthCameras told = synth.job.cameras;
  std::vector<Attribute> attributes = {string_attribute("varve:scene", synth.job.scene)};
  if (told == SynthCameras::attributes || told == SynthCameras::both) {
    attributes.push_back(number_attribute("worldToCamera", "m44f", numbers_of(world_to_camera(camera))));
    attributes.push_back(number_attribute("worldToNDC", "m44f", numbers_of(world_to_ndc(camera, width, height))));
  }
  if (told == SynthCameras::note || told == SynthCameras::both)
    attributes.push_back(string_attribute("Note", "{\"view\":" + json_matrix(opengl_view(camera)) + ",\"proj\":" +
                                                      json_matrix(opengl_projection(camera, width, height)) + "}"));
  return attributes;
}

NewPart new_part(const Synth& synth, const Moment& moment, const ChannelStore& store) {
  return {"", synth.window, synth.window, Compression::zip, store.channels, attributes_of(synth, moment)};
}

void write_samples(Synth& synth, int frame) {
  const SynthJob& job = synth.job;
  const Moment moment = synth.moment(frame);
  std::vector<ChannelStore> stores(static_cast<std::size_t>(job.samples));
  std::vector<NewPart> parts;
  for (int s = 0; s < job.samples; ++s) {
    ChannelStore& store = stores[std::size_t(s)];
    const synth::SampleSettings settings{jitter_at(synth, frame, s), job.noise, synth.key(frame, std::uint64_t(s))};
    add_picture(store, "", synth::render_samples(moment, synth.window, settings, synth.workers), job.type);
    if (job.layers)
      for (const LayerName& layer : kLayers) {
        const Moment alone = synth.moment(frame, layer.layer);
        add_picture(store, layer.name, synth::render_samples(alone, synth.window, settings, synth.workers), job.type);
      }
    NewPart part = new_part(synth, moment, store);
    if (job.samples > 1) part.name = "sample." + std::to_string(s);
    part.attributes.push_back(string_attribute("varve:motion", "varve"));
    part.attributes.push_back(number_attribute("jitter", "v2f", {settings.jitter.x, settings.jitter.y}));
    parts.push_back(std::move(part));
  }
  write_new_file(synth.path("", frame), parts, kZipLevel, synth.workers);
}

void write_stratified(Synth& synth, const std::string& folder, int frame, int n, synth::Filter filter,
                      std::uint64_t purpose) {
  const Moment moment = synth.moment(frame);
  const synth::Truth truth =
      synth::render_stratified(moment, synth.window, n, filter, synth.key(frame, purpose), synth.workers);
  ChannelStore store;
  // Truth is kept whole: half would round away what better and better resolvers differ in.
  store.add("R", truth.r, PixelType::float32);
  store.add("G", truth.g, PixelType::float32);
  store.add("B", truth.b, PixelType::float32);
  store.add("A", truth.a, PixelType::float32);
  const NewPart part = new_part(synth, moment, store);
  write_new_file(synth.path(folder, frame), {&part, 1}, kZipLevel, synth.workers);
}

void write_jitter(const Synth& synth, const std::vector<int>& frames) {
  const bool several = synth.job.samples > 1;
  std::string text = several ? "frame,sample,jx,jy\n" : "frame,jx,jy\n";
  for (const int frame : frames)
    for (int s = 0; s < synth.job.samples; ++s) {
      const glm::dvec2 jitter = jitter_at(synth, frame, s);
      text += std::to_string(frame) + "," + (several ? std::to_string(s) + "," : "") + json_number(jitter.x) + "," +
              json_number(jitter.y) + "\n";
    }
  OutputBytes file((std::filesystem::path(synth.job.folder) / "jitter.csv").string());
  file.append(text.data(), text.size());
  file.commit();
}

void make_folders(const SynthJob& job) {
  std::vector<std::string> below = {""};
  if (job.truth) below.push_back("truth");
  for (const int n : job.yardsticks) below.push_back("ss" + std::to_string(n));
  for (const std::string& name : below) {
    const std::filesystem::path folder = std::filesystem::path(job.folder) / name;
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem)
      throw Failure(ExitCode::output, "cannot make the folder '" + folder.string() + "': " + problem.message() +
                                          "; choose another with --output");
  }
}

}  // namespace

int synth_sequence(const SynthJob& job, const SynthEvents& events) {
  Synth synth(job);
  check(job, synth);
  std::vector<int> frames = job.frames;
  if (frames.empty())
    for (int frame = 1; frame <= synth.scene.frames; ++frame) frames.push_back(frame);
  for (const int frame : frames) jitter_at(synth, frame, 0);  // a gap in a table is told before anything is written
  make_folders(job);
  write_jitter(synth, frames);
  const auto stopped = [&] { return events.should_stop && events.should_stop(); };
  int done = 0;
  for (const int frame : frames) {
    if (stopped()) break;
    write_samples(synth, frame);
    for (const int n : job.yardsticks)
      if (!stopped())
        write_stratified(synth, "ss" + std::to_string(n), frame, n, synth::Filter::box,
                         kYardstickKey + std::uint64_t(n));
    if (job.truth && !stopped())
      write_stratified(synth, "truth", frame, int(std::ceil(std::sqrt(double(job.truth_samples)))), *job.truth,
                       kTruthKey);
    ++done;
    if (events.frame) events.frame(frame, done, int(frames.size()));
  }
  return done;
}

}  // namespace varve
