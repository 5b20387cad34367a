// --report as a farm meets it: every field of the schema, whatever the end.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>

#include "base/json.h"
#include "paths.h"
#include "scene_cli.h"
#include "sentence.h"
#include "small_sequence.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

bool is_type(const JsonValue& value, const std::string& type) {
  switch (value.kind) {
    case JsonValue::Kind::null:
      return type == "null";
    case JsonValue::Kind::boolean:
      return type == "boolean";
    case JsonValue::Kind::number:
      return type == "number" || (type == "integer" && value.number == std::floor(value.number));
    case JsonValue::Kind::string:
      return type == "string";
    case JsonValue::Kind::array:
      return type == "array";
    case JsonValue::Kind::object:
      return type == "object";
  }
  return false;
}

/// What of `value` breaks `schema`; empty when nothing does. As much of JSON Schema as the schema of the report uses.
std::string violation(const JsonValue& value, const JsonValue& schema, const std::string& at) {
  const JsonValue* type = schema.find("type");
  if (!type) return at + ": the schema names no type";
  bool fits = type->kind == JsonValue::Kind::string && is_type(value, type->text);
  for (const JsonValue& one : type->items) fits = fits || is_type(value, one.text);
  if (!fits) return at + ": has another type";
  const JsonValue *least = schema.find("minimum"), *items = schema.find("items"), *required = schema.find("required"),
                  *properties = schema.find("properties");
  if (least && value.kind == JsonValue::Kind::number && !(value.number >= least->number)) return at + ": is too small";
  for (std::size_t i = 0; items && i < value.items.size(); ++i)
    if (const std::string why = violation(value.items[i], *items, at + "[" + std::to_string(i) + "]"); !why.empty())
      return why;
  if (required)
    for (const JsonValue& name : required->items)
      if (!value.find(name.text)) return at + ": lacks " + name.text;
  for (const JsonMember& member : value.members) {
    const JsonValue* property = properties ? properties->find(member.name) : nullptr;
    if (!property) return at + ": has " + member.name + ", which the schema does not know";
    if (const std::string why = violation(member.value, *property, at + "." + member.name); !why.empty()) return why;
  }
  return "";
}

class Report : public SceneCli {
 protected:
  void SetUp() override { write_small_sequence(folder.path()); }

  Outcome run(const Arguments& more) const { return resolve_into("in.####.exr", "o", {"--report", "r.json"}, more); }

  /// The report, which keeps to the schema and tells no time of day.
  JsonValue report() const {
    const std::string text = bytes_of(folder / "r.json"), schema = run_varve({"help", "report-schema"}).out;
    const std::optional<JsonValue> parsed = parse_json(text), rules = parse_json(schema);
    EXPECT_TRUE(parsed && rules) << text;
    if (!parsed || !rules) return {};
    EXPECT_EQ(violation(*parsed, *rules, "report"), "");
    return *parsed;
  }
  static std::string text_of(const JsonValue& report, const char* name) {
    const JsonValue* value = report.find(name);
    return value ? value->text : "missing";
  }
  static double number_of(const JsonValue& report, const char* name) {
    const JsonValue* value = report.find(name);
    return value ? value->number : -1;
  }
};

TEST_F(Report, OfARunThatIsDone) {
  ASSERT_EQ(run({"--aov", "count"}).code, 0);
  const JsonValue r = report();
  EXPECT_EQ(text_of(r, "schema"), "varve-report-1");
  EXPECT_EQ(text_of(r, "outcome"), "done");
  EXPECT_EQ(text_of(r, "sentence"), "");
  EXPECT_NE(text_of(r, "parameters").find("alpha=0.1"), std::string::npos);
  EXPECT_EQ(text_of(r, "hash").size(), 16u);
  ASSERT_EQ(r.find("frames")->items.size(), 8u);
  EXPECT_FALSE(r.find("passes")->items.empty());
  EXPECT_FALSE(r.find("notes")->items.empty());
  const JsonValue &first = r.find("frames")->items[0], *summary = r.find("summary");
  EXPECT_EQ(number_of(first, "pixels"), 64 * 48);
  EXPECT_EQ(number_of(first, "restarted"), 64 * 48);
  EXPECT_EQ(number_of(first, "rejected_first"), 64 * 48);
  EXPECT_EQ(text_of(first, "restart"), "first frame");
  EXPECT_EQ(number_of(*summary, "frames_written"), 8);
  EXPECT_EQ(number_of(*summary, "pixels"), 8 * 64 * 48);
}

TEST_F(Report, ItsSchemaIsTheOneThatIsInstalled) {
  EXPECT_EQ(run_varve({"help", "report-schema"}).out, bytes_of(VARVE_SOURCE "/schema/varve-report-1.schema.json"))
      << "scripts/renew_man writes it again; a change of what it says needs another number";
}

TEST_F(Report, OfARunThatFailsOnTheWay) {
  fs::resize_file(folder / "in.0005.exr", fs::file_size(folder / "in.0005.exr") - 64);
  expect_refused(run({}), 3, "in.0005.exr");
  const JsonValue r = report();
  EXPECT_EQ(text_of(r, "outcome"), "failed");
  EXPECT_EQ(number_of(r, "exit_code"), 3);
  EXPECT_NE(text_of(r, "sentence").find("in.0005.exr"), std::string::npos);
  EXPECT_EQ(r.find("frames")->items.size(), 4u);
  EXPECT_EQ(number_of(*r.find("summary"), "frames_written"), 4);
  EXPECT_EQ(number_of(*r.find("summary"), "frames_requested"), 8);
}

TEST_F(Report, OfARunThatFailsBeforeItBegins) {
  expect_refused(run({"-f", "1-9"}), 3, "in.0009.exr");
  EXPECT_EQ(text_of(report(), "outcome"), "failed");
  expect_refused(run({"--layer", "fog"}), 4, "fog");
  EXPECT_NE(text_of(report(), "sentence").find("fog"), std::string::npos) << "an earlier report gives way";
  // Anything else does not, not even where nobody has come to look at the outputs.
  std::ofstream(folder / "r.json") << "precious";
  expect_refused(run({"--layer", "fog"}), 4, "fog");
  EXPECT_EQ(bytes_of(folder / "r.json"), "precious");
  const std::string frame = bytes_of(folder / "in.0003.exr");
  expect_refused(run({"--report", "in.0003.exr"}), 2, "in.0003.exr");
  EXPECT_EQ(bytes_of(folder / "in.0003.exr"), frame);
}

TEST_F(Report, OfARunThatWasStopped) {
  write_small_sequence(folder.path(), {.frames = 9, .width = 800, .height = 500});
  fs::create_directory(folder / "o");
  Running running({"resolve", "in.####.exr", "-o", "o/o.####.exr", "--report", "r.json"}, folder.path());
  while (!running.finished() && !fs::exists(path("o", 1))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  running.send(SIGTERM);
  const Outcome outcome = running.wait();
  EXPECT_EQ(outcome.code, 143);
  EXPECT_NE(outcome.err.find("--resume"), std::string::npos) << outcome.err;
  const JsonValue r = report();
  EXPECT_EQ(text_of(r, "outcome"), "stopped");
  EXPECT_EQ(number_of(r, "exit_code"), 143);
  EXPECT_NE(text_of(r, "sentence").find("--resume"), std::string::npos);
  EXPECT_GE(r.find("frames")->items.size(), 1u);
  EXPECT_LT(r.find("frames")->items.size(), 9u);
}

TEST_F(Report, CountsWhatTheFirefliesLose) {
  synth("crossing", "1-4", {"--size", "40x23"});
  const auto removed = [&](const char* limit) {
    EXPECT_EQ(
        resolve_into("in/crossing.####.exr", "g", {"-p", "draft", "--report", "r.json"}, {"--firefly-limit", limit})
            .code,
        0);
    double sum = 0;
    for (const JsonValue& frame : report().find("frames")->items) sum += number_of(frame, "removed_light");
    return sum;
  };
  EXPECT_EQ(removed("0"), 0);
  EXPECT_GT(removed("2"), 0);
}

TEST_F(Report, OnlyTimesDifferFromRunToRun) {
  const auto without_times = [&] {
    EXPECT_EQ(run({}).code, 0);
    std::string text = bytes_of(folder / "r.json");
    for (std::size_t at = 0; (at = text.find("seconds\":", at)) != std::string::npos;)
      text.erase(at + 9, text.find(',', at) - at - 9), at += 9;
    return text;
  };
  const std::string first = without_times();
  EXPECT_EQ(without_times(), first);
}

}  // namespace
}  // namespace varve::test
