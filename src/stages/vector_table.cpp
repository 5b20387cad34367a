#include "stages/vector_table.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <tuple>

#include "base/json.h"
#include "plan/repair_plan.h"
#include "stages/repair_vectors.h"
#include "stages/source_frame.h"

namespace varve {
namespace {

using Names = std::map<std::uint32_t, std::string>;

/// Names by hash, from every Cryptomatte manifest in the headers; what is no manifest has no say.
Names names_of(const FrameHeaders& headers) {
  Names names;
  for (const FileHeader& file : headers.files)
    for (const Part& part : file.parts)
      for (const Attribute& a : part.attributes) {
        if (!a.name.starts_with("cryptomatte/") || !a.name.ends_with("/manifest")) continue;
        const std::optional<JsonValue> manifest = parse_json(a.text);
        if (!manifest || manifest->kind != JsonValue::Kind::object) continue;
        for (const JsonMember& m : manifest->members)
          if (m.value.kind == JsonValue::Kind::string && m.value.text.size() == 8)
            names.try_emplace(std::uint32_t(std::strtoul(m.value.text.c_str(), nullptr, 16)), m.name);
      }
  return names;
}

/// Identities are read as bits: whole numbers as they are, hashes and numbers in floats by their pattern.
std::string id_text(std::uint32_t id, const Channel& channel, bool hash) {
  char text[40];
  if (hash)
    std::snprintf(text, sizeof text, "%08x", unsigned(id));
  else if (channel.type == PixelType::uint32)
    std::snprintf(text, sizeof text, "%u", unsigned(id));
  else
    std::snprintf(text, sizeof text, "%g", double(std::bit_cast<float>(id)));
  return text;
}

/// Adds what one pair of frames says of a surface.
void add(ObjectVectors& to, const SurfaceVectors& s) {
  ++to.frames;
  to.pixels += s.pixels, to.tested += s.tested, to.suspicious += s.suspicious;
  to.zero += s.zero, to.unusable += s.unusable, to.lost += s.lost;
  if (!s.wrong) return;
  ++to.wrong_frames;
  const double before = double(to.wrong), n = double(s.pixels);
  to.wrong += s.pixels;
  to.stored = (before * to.stored + n * s.stored) / (before + n);
  to.found = (before * to.found + n * s.found) / (before + n);
  to.apart = (before * to.apart + n * s.apart) / (before + n);
}

std::vector<std::pair<int, int>> neighbors_among(const std::vector<int>& frames, int count) {
  std::vector<std::pair<int, int>> all, chosen;
  for (std::size_t k = 0; k + 1 < frames.size(); ++k)
    if (frames[k + 1] == frames[k] + 1) all.emplace_back(frames[k], frames[k + 1]);
  const std::size_t most = std::min(all.size(), std::size_t(std::max(count, 0)));
  for (std::size_t k = 0; k < most; ++k) chosen.push_back(all[(2 * k + 1) * all.size() / (2 * most)]);
  return chosen;
}

std::string pair_text(glm::dvec2 v) {
  char text[60];
  std::snprintf(text, sizeof text, "(%.1f, %.1f)", v.x, v.y);
  return text;
}

std::string named(const ObjectVectors& o) {
  std::string text = o.id.empty() ? "things without an id" : "object " + o.id;
  if (!o.name.empty()) text += " '" + o.name + "'";
  if (!o.layer.empty()) text += " of layer " + o.layer;
  if (!o.view.empty()) text += " in view " + o.view;
  return text;
}

}  // namespace

VectorTable inspect_vectors(const ResolveJob& job, const SequenceInfo& info, const Plan& plan,
                            const JitterSource& jitter, int pairs, Workers& workers) {
  Plan reads = plan;
  reads.use_motion = reads.use_forward = reads.use_depth = reads.use_id = true;
  reads.use_cameras = reads.use_cameras || repair_uses_cameras(info);
  const CameraSource cameras_given = parse_camera_source(job.camera);
  CameraTrack track = info.cameras;
  const ExtraSamples no_extras;
  const SourceOptions options{job, info, reads, jitter, cameras_given, track, no_extras, nullptr, false, false};
  RepairParameters parameters = job.parameters.repair;
  parameters.mode = RepairMotion::check;
  VectorTable table;
  table.pairs = neighbors_among(info.frames, pairs);
  std::map<std::tuple<std::size_t, std::uint32_t>, ObjectVectors> objects;
  for (const auto& [before, after] : table.pairs) {
    const SourceFrame earlier = read_source_frame(options, before, {{}, after}, workers),
                      later = read_source_frame(options, after, {before, {}}, workers);
    const Names names = names_of(later.headers);
    for (std::size_t k = 0; k < std::min(later.presents.size(), later.headers.subjects.size()); ++k) {
      const Subject& subject = later.headers.subjects[k];
      const bool past = !later.presents[k].motion.empty();
      const Present &here = past ? later.presents[k] : earlier.presents[k],
                    &there = past ? earlier.presents[k] : later.presents[k];
      const Plane<glm::vec2>& stored = past ? here.motion : here.forward;
      if (stored.empty()) continue;
      Plane<glm::vec2> vectors = stored.clone();
      const CamerasAround cameras = cameras_of(past ? later : earlier, k);
      const SeenPlanes a = seen_planes(here, cameras, parameters, workers),
                       b = seen_planes(there, {}, parameters, workers);
      const Plane<glm::vec2> resting =
          resting_motion(past ? cameras.before : cameras.after, a.depth, a.jitter, workers);
      const MotionRepair said =
          repair_motion(vectors, a.view(), b.view(), past ? there.forward : there.motion, resting, parameters, workers);
      for (const SurfaceVectors& s : said.surfaces) {
        ObjectVectors& object = objects[{k, subject.id ? s.label : 0}];
        object.layer = subject.layer;
        object.view = subject.default_view ? "" : subject.view;
        if (subject.id) {
          const auto name = names.find(s.label);
          const Part& part = later.headers.files[std::size_t(subject.id->file)].parts[std::size_t(subject.id->part)];
          const Channel& channel = part.channels[std::size_t(subject.id->channel)];
          object.id = id_text(s.label, channel, classify(channel) == ChannelClass::cryptomatte);
          if (name != names.end()) object.name = name->second;
        }
        add(object, s);
      }
    }
  }
  for (auto& [key, object] : objects) table.objects.push_back(std::move(object));
  std::stable_sort(table.objects.begin(), table.objects.end(), [](const ObjectVectors& a, const ObjectVectors& b) {
    return (a.wrong_frames > 0) > (b.wrong_frames > 0);
  });
  return table;
}

std::string sentence_of(const ObjectVectors& o) {
  if (o.wrong_frames == 0) return "";
  std::string text = named(o) + ": ";
  char number[40];
  std::snprintf(number, sizeof number, "%.1f", o.apart);
  if (o.apart == 0)
    text += "its vectors lead where it is not, and where it came from was not found";
  else if (10 * o.zero >= 9 * o.pixels)
    text += "vectors are zero but its pixels move by about " + std::string(number) + " px a frame";
  else
    text += "vectors are off by about " + std::string(number) + " px: on average they say " + pair_text(o.stored) +
            ", its pixels say " + pair_text(o.found);
  if (o.wrong_frames < o.frames)
    text += ", in " + std::to_string(o.wrong_frames) + " of " + std::to_string(o.frames) + " frames";
  return text;
}

std::string vector_table_text(const VectorTable& table) {
  std::string text = "\nvectors by object, " + std::to_string(table.pairs.size()) + " pairs of frames\n";
  if (table.pairs.empty()) return text + "  no two frames are neighbors, so nothing can be tested\n";
  if (table.objects.empty()) return text + "  there are no vectors\n";
  text += "  object                          pixels  suspicious   wrong in   vectors say   pixels say   apart\n";
  for (const ObjectVectors& o : table.objects) {
    const std::string who = o.id.empty() ? "(no ids)" : o.id + (o.name.empty() ? "" : " " + o.name);
    char line[260];
    std::snprintf(line, sizeof line, "  %-28.60s %9zu %10.1f%% %5d of %-4d", who.c_str(),
                  o.pixels / std::size_t(std::max(1, o.frames)),
                  o.tested > 0 ? 100.0 * double(o.suspicious) / double(o.tested) : 0.0, o.wrong_frames, o.frames);
    text += line;
    if (o.wrong_frames > 0) {
      std::snprintf(line, sizeof line, " %12s %12s %7.1f", pair_text(o.stored).c_str(),
                    o.apart > 0 ? pair_text(o.found).c_str() : "not found", o.apart);
      text += line;
    }
    text += "\n";
  }
  for (const ObjectVectors& o : table.objects)
    if (const std::string sentence = sentence_of(o); !sentence.empty()) text += "  " + sentence + "\n";
  return text;
}

std::string vector_table_json(const VectorTable& table) {
  std::string text = "{\"pairs\":[";
  for (const auto& [a, b] : table.pairs)
    text += (text.back() == '[' ? "[" : ",[") + std::to_string(a) + "," + std::to_string(b) + "]";
  text += "],\"objects\":[";
  for (const ObjectVectors& o : table.objects) {
    const auto pair = [](glm::dvec2 v) { return "[" + json_number(v.x) + "," + json_number(v.y) + "]"; };
    const auto count = [](const char* name, std::size_t n) {
      return ",\"" + std::string(name) + "\":" + std::to_string(n);
    };
    text += (text.back() == '[' ? "{" : ",{");
    text += "\"layer\":" + json_quote(o.layer) + ",\"view\":" + json_quote(o.view) + ",\"id\":" + json_quote(o.id) +
            ",\"name\":" + json_quote(o.name) + count("frames", std::size_t(o.frames)) +
            count("wrong_frames", std::size_t(o.wrong_frames)) + count("pixels", o.pixels) + count("tested", o.tested) +
            count("suspicious", o.suspicious) + count("zero", o.zero) + count("unusable", o.unusable) +
            count("lost", o.lost) + ",\"stored\":" + pair(o.stored) + ",\"found\":" + pair(o.found) +
            ",\"apart\":" + json_number(o.apart) + ",\"sentence\":" + json_quote(sentence_of(o)) + "}";
  }
  return text + "]}";
}

}  // namespace varve
