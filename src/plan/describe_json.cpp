#include <algorithm>
#include <initializer_list>
#include <utility>

#include "base/words.h"
#include "plan/describe.h"

namespace varve {
namespace {

// Values are put together as text: the schema is small, and its order is part of it.
std::string whole(std::size_t value) { return std::to_string(value); }
std::string text_or_null(const std::string& text) { return text.empty() ? "null" : json_quote(text); }

std::string window(const Window& w) {
  return json_array(std::initializer_list<int>{w.x0, w.y0, w.x1, w.y1}, [](int i) { return std::to_string(i); });
}

std::string channel_name(const SequenceInfo& info, ChannelRef ref) {
  const FileHeader& file = info.first.files[std::size_t(ref.file)];
  const Part& part = file.parts[std::size_t(ref.part)];
  return (file.parts.size() > 1 && !part.name.empty() ? part.name + ":" : "") +
         part.channels[std::size_t(ref.channel)].name;
}

std::string vector_json(const SequenceInfo& info, const std::optional<VectorChannels>& vector) {
  return vector ? json_array(*vector, [&](ChannelRef ref) { return json_quote(channel_name(info, ref)); }) : "null";
}

std::string layer_json(const SequenceInfo& info, const Subject& s) {
  return json_object({{"layer", json_quote(s.layer)},
                      {"view", json_quote(s.view)},
                      {"default_view", json_boolean(s.default_view)},
                      {"convention", text_or_null(s.convention)},
                      {"depth", s.depth ? json_quote(channel_name(info, *s.depth)) : "null"},
                      {"motion", vector_json(info, s.backward)},
                      {"forward", vector_json(info, s.forward)}});
}

std::string part_json(const SequenceInfo& info, const Plan& plan, int f, int p) {
  const Part& part = files_on_disk(info.first)[std::size_t(f)].parts[std::size_t(p)];
  ChannelRef ref{f, p, 0};
  const std::string channels = json_array(part.channels, [&](const Channel& channel) {
    const bool read = std::find(plan.channels.begin(), plan.channels.end(), ref) != plan.channels.end();
    std::string json = json_object({{"name", json_quote(channel.name)},
                                    {"type", json_quote(name_of(channel.type))},
                                    {"class", json_quote(name_of(classify(channel)))},
                                    {"role", text_or_null(roles_of(info, ref))},
                                    {"read", json_boolean(read)}});
    ++ref.channel;
    return json;
  });
  return json_object({{"name", json_quote(part.name)},
                      {"view", json_quote(part.view)},
                      {"storage", json_quote(name_of(part.storage))},
                      {"compression", json_quote(name_of(part.compression))},
                      {"data_window", window(part.data_window)},
                      {"display_window", window(part.display_window)},
                      {"channels", channels}});
}

std::string files_json(const SequenceInfo& info, const Plan& plan) {
  int f = 0;
  return json_array(files_on_disk(info.first), [&](const FileHeader& file) {
    int p = 0;
    const std::string parts = json_array(file.parts, [&](const Part&) { return part_json(info, plan, f, p++); });
    ++f;
    return json_object({{"path", json_quote(file.path)}, {"bytes", std::to_string(file.file_bytes)}, {"parts", parts}});
  });
}

std::string plan_json(const Plan& plan) {
  const std::string passes = json_array(plan.passes, [](const PlannedPass& pass) {
    return json_object(
        {{"name", json_quote(pass.name)}, {"runs", json_boolean(pass.runs)}, {"reason", json_quote(pass.reason)}});
  });
  return json_object(
      {{"passes", passes}, {"bytes", whole(plan.bytes)}, {"seconds_per_frame", json_number(plan.seconds_per_frame)}});
}

std::string samples_json(const SequenceInfo& info) {
  if (info.first.sample_jitter.empty()) return "null";
  const ColorOutput& output = info.first.outputs.front();
  return json_object({{"count", whole(output.inputs.size())},
                      {"grid", info.first.grid > 1 ? std::to_string(info.first.grid) : "null"},
                      {"mode", json_quote(output.after ? "each" : "resolve")},
                      {"positions_known", json_boolean(info.first.jitter.has_value())}});
}

std::string statistics_json(const std::vector<ChannelStatistics>& statistics) {
  return json_array(statistics, [](const ChannelStatistics& s) {
    return json_object({{"frame", std::to_string(s.frame)},
                        {"part", json_quote(s.part)},
                        {"channel", json_quote(s.channel)},
                        {"role", json_quote(s.role)},
                        {"least", json_number(s.least)},
                        {"greatest", json_number(s.greatest)},
                        {"mean", json_number(s.mean)},
                        {"pixels", whole(s.pixels)},
                        {"not_finite", whole(s.not_finite)},
                        {"zero", whole(s.zero)}});
  });
}

}  // namespace

std::string describe_json(const SequenceInfo& info, const Plan& plan, const std::vector<ChannelStatistics>& statistics,
                          const std::string& motion) {
  std::vector<std::string> notes = plan.notes;
  notes.insert(notes.end(), info.notes.begin(), info.notes.end());
  const std::string frames = json_object({{"list", json_quote(format_frame_list(info.frames))},
                                          {"count", whole(info.frames.size())},
                                          {"first", std::to_string(info.frames.empty() ? 0 : info.frames.front())},
                                          {"last", std::to_string(info.frames.empty() ? 0 : info.frames.back())},
                                          {"gaps", json_quote(format_frame_list(info.gaps))}});
  return json_object(
             {{"frames", frames},
              {"files", files_json(info, plan)},
              {"windows", json_object({{"data_moves", json_boolean(info.windows_move)},
                                       {"display_differs", json_boolean(info.windows_differ)}})},
              {"layers", json_array(info.first.subjects, [&](const Subject& s) { return layer_json(info, s); })},
              {"samples", samples_json(info)},
              {"jitter", json_object({{"source", json_quote(info.jitter_source)},
                                      {"frames", std::to_string(info.frames_with_jitter)}})},
              {"camera",
               json_object({{"source", json_quote(info.camera)}, {"frames", std::to_string(info.frames_with_camera)}})},
              {"plan", plan_json(plan)},
              {"statistics", statistics_json(statistics)},
              {"findings", json_array(findings(info, statistics), json_quote)},
              {"notes", json_array(notes, json_quote)},
              {"motion", motion.empty() ? "null" : motion}}) +
         "\n";
}

}  // namespace varve
