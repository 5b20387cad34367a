#include "report.h"

#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/json.h"
#include "base/version.h"
#include "exr/output_bytes.h"
#include "report_fields.h"

namespace varve::cli {
namespace {

std::string list_text(const std::vector<std::string>& items, const char* between = ",") {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : between) + item;
  return "[" + text + "]";
}

std::string texts(const std::vector<std::string>& sentences) {
  std::vector<std::string> quoted;
  for (const std::string& sentence : sentences) quoted.push_back(json_quote(sentence));
  return list_text(quoted);
}

std::vector<ReportField<PlannedPass>> pass_fields() {
  return {{"name", FieldKind::text, "Name of the pass.", [](const PlannedPass& p) { return json_quote(p.name); }},
          {"runs", FieldKind::flag, "Whether it runs.",
           [](const PlannedPass& p) { return std::string(p.runs ? "true" : "false"); }},
          {"reason", FieldKind::text, "Why, or why not.", [](const PlannedPass& p) { return json_quote(p.reason); }}};
}

double total(const RunReport& report, double FrameReport::*member) {
  double sum = 0;
  for (const FrameReport& frame : report.frames) sum += frame.*member;
  return sum;
}

std::size_t total(const RunReport& report, std::size_t FrameReport::*member) {
  std::size_t sum = 0;
  for (const FrameReport& frame : report.frames) sum += frame.*member;
  return sum;
}

using RunField = ReportField<RunReport>;

std::vector<RunField> summary_fields() {
  const auto count = [](const char* name, const char* meaning, auto get) -> RunField {
    return {name, FieldKind::count, meaning, [get](const RunReport& r) { return std::to_string(get(r)); }};
  };
  const auto seconds = [](const char* name, const char* meaning, auto get) -> RunField {
    return {name, FieldKind::number, meaning, [get](const RunReport& r) { return json_number(get(r)); }};
  };
  return {
      count("frames_requested", "Frames to write.", [](const RunReport& r) { return r.frames_requested; }),
      count("frames_written", "Frames that were written.", [](const RunReport& r) { return r.summary.frames_written; }),
      count("frames_skipped", "Frames that were complete before.",
            [](const RunReport& r) { return r.summary.frames_skipped; }),
      seconds("seconds", "Wall time of the run.", [](const RunReport& r) { return r.seconds; }),
      seconds("read_seconds", "Of that, to read and decode.",
              [](const RunReport& r) { return total(r, &FrameReport::read_seconds); }),
      seconds("resolve_seconds", "To resolve.",
              [](const RunReport& r) { return total(r, &FrameReport::resolve_seconds); }),
      seconds("write_seconds", "To encode and write.",
              [](const RunReport& r) { return total(r, &FrameReport::write_seconds); }),
      count("pixels", "Sum over the frames.", [](const RunReport& r) { return total(r, &FrameReport::pixels); }),
      count("not_finite", "Sum over the frames.",
            [](const RunReport& r) { return total(r, &FrameReport::not_finite); }),
      count("restarted", "Sum over the frames.", [](const RunReport& r) { return total(r, &FrameReport::restarted); }),
      count("clipped", "Sum over the frames.", [](const RunReport& r) { return total(r, &FrameReport::clipped); }),
      count("half_overflows", "Sum over the frames.",
            [](const RunReport& r) { return total(r, &FrameReport::half_overflows); }),
  };
}

/// What stands at the top; passes, summary and frames follow.
std::vector<RunField> run_fields() {
  const auto text = [](const char* name, const char* meaning, std::string RunReport::*member) -> RunField {
    return {name, FieldKind::text, meaning, [member](const RunReport& r) { return json_quote(r.*member); }};
  };
  return {
      {"schema", FieldKind::text, "Always varve-report-1; another number means other fields.",
       [](const RunReport&) { return json_quote(kReportSchema); }},
      {"version", FieldKind::text, "Version of the program.", [](const RunReport&) { return json_quote(version()); }},
      text("outcome", "done, stopped (by a signal), or failed.", &RunReport::outcome),
      {"exit_code", FieldKind::count, "As the program ended.",
       [](const RunReport& r) { return std::to_string(r.exit_code); }},
      text("sentence", "Why it stopped or failed; empty when done.", &RunReport::sentence),
      text("parameters", "Everything that decides the pixels, as in the headers of the outputs.",
           &RunReport::parameters),
      text("hash", "Hash of parameters and version, as in the headers.", &RunReport::hash),
      {"notes", FieldKind::texts, "What was found and assumed before the work began.",
       [](const RunReport& r) { return texts(r.notes); }},
      {"warnings", FieldKind::texts, "What was warned of, in order.",
       [](const RunReport& r) { return texts(r.warnings); }}};
}

/// The members that hold objects.
struct Nested {
  const char *name, *meaning;
  bool is_list;
  std::string schema;
};
std::vector<Nested> nested() {
  return {{"passes", "The plan: each pass, and why it runs or not.", true, object_schema(pass_fields())},
          {"summary", "Of the whole run.", false, object_schema(summary_fields())},
          {"frames", "One row for each frame that was looked at, in order; so far, where the run did not end.", true,
           object_schema(frame_fields())}};
}

}  // namespace

std::string report_text(const RunReport& report) {
  std::vector<std::string> passes, frames;
  for (const PlannedPass& pass : report.passes) passes.push_back(object_text(pass_fields(), pass));
  const auto fields = frame_fields();
  for (const FrameReport& frame : report.frames) frames.push_back("\n" + object_text(fields, frame));
  std::string text = object_text(run_fields(), report);
  text.pop_back();
  return text + ",\n\"passes\":" + list_text(passes) + ",\n\"summary\":" + object_text(summary_fields(), report) +
         ",\n\"frames\":" + list_text(frames) + "}\n";
}

std::string report_schema() {
  std::vector<std::string> names;
  std::string properties;
  for (const RunField& field : run_fields()) {
    names.push_back(field.name);
    properties += (properties.empty() ? "\n" : ",\n") + property_schema(field.name, field.kind, field.meaning);
  }
  for (const Nested& member : nested()) {
    names.push_back(member.name);
    properties += std::string(",\n  \"") + member.name + "\": {\"description\": " + json_quote(member.meaning) + ",\n" +
                  (member.is_list ? "\"type\": \"array\", \"items\": {" + member.schema + "}}" : member.schema + "}");
  }
  return std::string("{\"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n\"title\": \"") + kReportSchema +
         "\",\n\"description\": \"What varve resolve --report writes.\",\n" + closed_object(names, properties) + "}\n";
}

Topic report_topic() {
  Topic topic{"report",
              "REPORT",
              "The JSON file of --report: one object. It is written when the run ends, also when it was stopped or has "
              "failed, with the rows of the frames so far. Times are durations in seconds, everything else is the same "
              "from run to run. `varve help report-schema` prints its JSON Schema, which is installed as "
              "share/varve/varve-report-1.schema.json.",
              {}};
  for (const RunField& field : run_fields()) topic.rows.emplace_back(field.name, field.meaning);
  for (const auto& field : pass_fields()) topic.rows.emplace_back("passes[]." + field.name, field.meaning);
  for (const RunField& field : summary_fields()) topic.rows.emplace_back("summary." + field.name, field.meaning);
  for (const auto& field : frame_fields()) topic.rows.emplace_back("frames[]." + field.name, field.meaning);
  return topic;
}

bool is_free_for_report(const std::string& path) {
  std::error_code problem;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, problem))) return true;
  constexpr std::string_view start = "{\"schema\":\"varve-report-";
  std::string begins(start.size(), ' ');
  std::ifstream(path, std::ios::binary).read(begins.data(), std::streamsize(begins.size()));
  return begins == start;
}

void write_file(const std::string& path, const std::string& text) {
  OutputBytes file(path);
  file.append(text.data(), text.size());
  file.commit();
}

}  // namespace varve::cli
