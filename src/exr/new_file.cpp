#include "exr/new_file.h"

#include <map>

#include "base/error.h"
#include "exr/header_bytes.h"
#include "exr/planned_file.h"

namespace varve {
namespace {

std::string floats(const std::vector<double>& numbers) {
  std::string bytes;
  for (const double number : numbers) append(bytes, float(number));
  return bytes;
}

std::string box_bytes(const Window& w) {
  std::string bytes;
  for (const int edge : {w.x0, w.y0, w.x1 - 1, w.y1 - 1}) append(bytes, std::int32_t(edge));
  return bytes;
}

RawAttribute encode_attribute(const Attribute& attribute, const std::string& path) {
  static const std::map<std::string, std::size_t> kFloats = {{"float", 1}, {"v2f", 2}, {"m44f", 16}};
  const auto floating = kFloats.find(attribute.type);
  if (attribute.type == "string") return {attribute.name, attribute.type, attribute.text};
  if (attribute.type == "int" && attribute.numbers.size() == 1) {
    std::string bytes;
    append(bytes, std::int32_t(attribute.numbers[0]));
    return {attribute.name, attribute.type, bytes};
  }
  if (floating == kFloats.end() || floating->second != attribute.numbers.size())
    throw Failure(ExitCode::output, "cannot write attribute '" + attribute.name + "' of '" + path + "': type '" +
                                        attribute.type + "' with " + std::to_string(attribute.numbers.size()) +
                                        " numbers is not one that a new file takes");
  return {attribute.name, attribute.type, floats(attribute.numbers)};
}

PlannedPart plan_new_part(const NewPart& request, const std::string& path, bool multi_part) {
  if (request.data_window.empty() || request.display_window.empty())
    throw Failure(ExitCode::output, "cannot write '" + path + "': a window is empty");
  PlannedPart plan;
  plan.part.name = request.name;
  plan.part.compression = request.compression;
  plan.part.data_window = request.data_window;
  plan.part.display_window = request.display_window;
  take_channels(request.channels, path, plan);
  set_scanlines(plan);
  plan.raw.set("dataWindow", "box2i", box_bytes(request.data_window));
  plan.raw.set("displayWindow", "box2i", box_bytes(request.display_window));
  plan.raw.set("pixelAspectRatio", "float", floats({1}));
  plan.raw.set("screenWindowCenter", "v2f", floats({0, 0}));
  plan.raw.set("screenWindowWidth", "float", floats({1}));
  if (!request.name.empty()) plan.raw.set("name", "string", request.name);
  for (const Attribute& attribute : request.attributes) {
    RawAttribute raw = encode_attribute(attribute, path);
    plan.raw.set(raw.name, raw.type, std::move(raw.value));
  }
  set_part_type(plan, multi_part);
  return plan;
}

}  // namespace

Attribute string_attribute(const std::string& name, const std::string& text) { return {name, "string", text, {}}; }

Attribute number_attribute(const std::string& name, const std::string& type, std::vector<double> numbers) {
  return {name, type, "", std::move(numbers)};
}

void write_new_file(const std::string& path, std::span<const NewPart> parts, int zip_level, Workers& workers) {
  if (parts.empty()) throw Failure(ExitCode::output, "cannot write '" + path + "': there is no part to write");
  check_writable(path);
  std::vector<PlannedPart> plans;
  for (const NewPart& request : parts) plans.push_back(plan_new_part(request, path, parts.size() > 1));
  write_planned(path, plans, [&](std::size_t i, const ChunkTarget& target) {
    return encode_part(plans[i], zip_level, target, workers);
  });
}

}  // namespace varve
