#include "exr/camera_source.h"

#include "base/error.h"
#include "base/json.h"
#include "exr/camera_matrices.h"
#include "exr/camera_table.h"

namespace varve {
namespace {

using Numbers = std::vector<double>;

FoundCamera told(MadeCamera made, std::string source) {
  return {std::move(made.camera), std::move(source), std::move(made.problem)};
}

Numbers matrix_attribute(const Part& part, std::string_view name) {
  const Attribute* found = part.attribute(name);
  return found && found->numbers.size() == 16 ? found->numbers : Numbers();
}

FoundCamera in_attributes(const Part& part) {
  const Numbers camera = matrix_attribute(part, "worldToCamera"), ndc = matrix_attribute(part, "worldToNDC");
  if (camera.empty() && ndc.empty()) return {};
  return told(camera_from_attributes(camera, ndc, part.display_window), ndc.empty() ? "worldToCamera"
                                                                        : camera.empty()
                                                                            ? "worldToNDC"
                                                                            : "worldToCamera and worldToNDC");
}

FoundCamera in_note(const Part& part) {
  const Attribute* text = part.attribute("Note");
  if (!text || text->type != "string") return {};
  const std::optional<JsonValue> note = parse_json(text->text);
  const auto matrix = [&](const char* name) {
    const JsonValue* member = note ? note->find(name) : nullptr;
    const std::optional<Numbers> numbers = member ? member->numbers() : std::nullopt;
    return numbers && numbers->size() == 16 ? *numbers : Numbers();
  };
  const Numbers view = matrix("view"), projection = matrix("proj");
  if (view.empty() || projection.empty()) return {};
  return told(camera_from_opengl(view, projection, part.display_window), "view and proj in the attribute Note");
}

FoundCamera in_table(const CameraSource& source, const Part& part, int frame) {
  const auto row = source.table.find(frame);
  if (row == source.table.end()) return {};
  const Attribute* aspect = part.attribute("pixelAspectRatio");
  const double pixel_aspect = aspect && !aspect->numbers.empty() ? aspect->numbers[0] : 1.0;
  const CameraRow& r = row->second;
  MadeCamera made = r.projection ? camera_from_opengl(r.view, *r.projection, part.display_window)
                                 : camera_from_film(r.view, r.focal, r.aperture, pixel_aspect, part.display_window);
  if (!made.camera)
    throw Failure(ExitCode::inconsistent, "frame " + std::to_string(frame) + ": its camera in " + source.description +
                                              " cannot be used: " + made.problem +
                                              "; correct that line, or give --camera off");
  return told(std::move(made), source.description);
}

}  // namespace

CameraSource parse_camera_source(const std::string& text) {
  CameraSource source;
  if (text == "auto") return source;
  source.kind = CameraSource::Kind::none;
  if (text == "off") return source;
  source.kind = CameraSource::Kind::table;
  source.table = read_camera_table(text);
  source.description = text;
  return source;
}

FoundCamera find_camera(const CameraSource& source, const Part& part, int frame) {
  if (source.kind == CameraSource::Kind::none) return {};
  if (source.kind == CameraSource::Kind::table) return in_table(source, part, frame);
  FoundCamera found = in_attributes(part);
  if (found.camera) return found;
  FoundCamera note = in_note(part);
  return note.camera || found.source.empty() ? note : found;
}

}  // namespace varve
