#include "report_fields.h"

#include <bit>
#include <limits>

#include "base/json.h"
#include "diagnose/aov.h"

namespace varve::cli {
namespace {

using Field = ReportField<FrameReport>;

Field text(const char* name, const char* meaning, std::string FrameReport::*member) {
  return {name, FieldKind::text, meaning, [member](const FrameReport& r) { return json_quote(r.*member); }};
}
Field flag(const char* name, const char* meaning, bool FrameReport::*member) {
  return {name, FieldKind::flag, meaning,
          [member](const FrameReport& r) { return std::string(r.*member ? "true" : "false"); }};
}
Field number(const char* name, const char* meaning, double FrameReport::*member) {
  return {name, FieldKind::number, meaning, [member](const FrameReport& r) { return json_number(r.*member); }};
}
Field count(const std::string& name, const std::string& meaning, std::function<std::size_t(const FrameReport&)> get) {
  return {name, FieldKind::count, meaning,
          [get = std::move(get)](const FrameReport& r) { return std::to_string(get(r)); }};
}
Field count(const char* name, const char* meaning, std::size_t FrameReport::*member) {
  return count(name, meaning, [member](const FrameReport& r) { return r.*member; });
}

// Lights of which a part only was named say nothing by their sum.
Field residual(const char* name, const char* meaning, double LightSum::*member) {
  return {name, FieldKind::number_or_null, meaning, [member](const FrameReport& r) {
            const bool adds_up = r.lights.pixels > 0 && r.lights.adding_up == r.lights.pixels;
            return json_number(adds_up ? r.lights.*member : std::numeric_limits<double>::quiet_NaN());
          }};
}

void add_vectors(std::vector<Field>& fields) {
  fields.push_back(count("vectors_bad", "Unusable vectors: not finite, or too long.", &FrameReport::vectors_bad));
  fields.push_back(count("with_vectors", "Pixels of everything resolved that has vectors; 0 without cameras.",
                         &FrameReport::with_vectors));
  fields.push_back(count("by_camera", "Pixels whose vector is that of a camera.", &FrameReport::by_camera));
  fields.push_back(
      count("lens_added", "Pixels to whose vector zoom or lens shift was added.", &FrameReport::lens_added));
  fields.push_back(count("vectors_tested", "Vectors that --repair-motion has tested, both directions.",
                         [](const FrameReport& r) { return r.vectors.pixels; }));
  fields.push_back(count("vectors_one_way", "Of these, vectors that the other direction does not confirm.",
                         [](const FrameReport& r) { return r.vectors.one_way; }));
  fields.push_back(
      count("vectors_doubtful", "Of these, vectors that the pixels speak against.",
            [](const FrameReport& r) { return r.vectors.verdicts[std::size_t(VectorVerdict::doubtful)]; }));
  const auto by = [&](const char* name, const char* meaning, RepairedBy how) {
    fields.push_back(count(name, meaning, [how](const FrameReport& r) { return r.vectors_by[std::size_t(how)]; }));
  };
  by("vectors_by_neighbor", "Vectors taken from a pixel of the same surface; under check, that would be.",
     RepairedBy::neighbor);
  by("vectors_by_camera", "Vectors made from the cameras in place of wrong ones.", RepairedBy::camera);
  by("vectors_by_search", "Vectors found in the pixels in place of wrong ones.", RepairedBy::search);
  by("vectors_dropped", "Vectors that were wrong and could not be replaced.", RepairedBy::dropped);
}

void add_history(std::vector<Field>& fields) {
  fields.push_back(count("restarted", "Pixels without usable history.", &FrameReport::restarted));
  fields.push_back(count("clipped", "Pixels whose history was moved by the rectification.", &FrameReport::clipped));
  for (const RejectName& reason : reject_bits()) {
    const std::size_t bit = std::size_t(std::countr_zero(reason.bit));
    fields.push_back(count("rejected_" + std::string(reason.name),
                           "Pixels with the bit " + std::to_string(reason.bit) +
                               " of the plane reject: " + std::string(reason.meaning) + ".",
                           [bit](const FrameReport& r) { return r.rejected[bit]; }));
  }
  fields.push_back(
      number("removed_light",
             "Luminance that --firefly-limit held back, summed over the pixels; scene-linear, in the unit of "
             "the input.",
             &FrameReport::removed_light));
}

void add_light(std::vector<Field>& fields) {
  fields.push_back(count("half_overflows", "Values beyond half that were held at 65504 when written.",
                         &FrameReport::half_overflows));
  fields.push_back(count("opacity_held", "Pixels of layers whose alpha or transmittance was held within 0 and 1.",
                         &FrameReport::opacity_held));
  fields.push_back(count("companions_not_finite", "Values of --channels that were NaN or infinite.",
                         &FrameReport::companions_not_finite));
  fields.push_back(count("deep_samples", "Samples of deep parts that were flattened.", &FrameReport::deep_samples));
  fields.push_back(count("deep_repaired",
                         "Of these, samples left out or put right: no depth, ZBack before Z, bad alpha.",
                         &FrameReport::deep_repaired));
  fields.push_back(count("light_pixels", "Pixels of colors that have --channels with them.",
                         [](const FrameReport& r) { return r.lights.pixels; }));
  fields.push_back(count("light_pixels_adding_up",
                         "Of these, pixels where the channels add up to the color in the input.",
                         [](const FrameReport& r) { return r.lights.adding_up; }));
  fields.push_back(residual("light_residual_input",
                            "Largest difference between the color and the sum of its channels in the input, relative; "
                            "null unless all pixels add up.",
                            &LightSum::input));
  fields.push_back(residual("light_residual", "The same after the resolve.", &LightSum::resolved));
}

const char* type_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::text:
      return "\"type\": \"string\"";
    case FieldKind::texts:
      return "\"type\": \"array\", \"items\": {\"type\": \"string\"}";
    case FieldKind::flag:
      return "\"type\": \"boolean\"";
    case FieldKind::integer:
      return "\"type\": \"integer\"";
    case FieldKind::count:
      return "\"type\": \"integer\", \"minimum\": 0";
    case FieldKind::number:
      return "\"type\": \"number\", \"minimum\": 0";
    case FieldKind::number_or_null:
      break;
  }
  return "\"type\": [\"number\", \"null\"], \"minimum\": 0";
}

}  // namespace

std::vector<ReportField<FrameReport>> frame_fields() {
  std::vector<Field> fields = {
      {"frame", FieldKind::integer, "Frame number.", [](const FrameReport& r) { return std::to_string(r.frame); }},
      text("path", "The file of the resolved frame; empty for a frame that is only read.", &FrameReport::path),
      flag("written", "Whether the file was written by this run.", &FrameReport::written),
      flag("skipped", "Whether it was complete before (--resume).", &FrameReport::skipped),
      number("read_seconds", "Wall time to read and decode.", &FrameReport::read_seconds),
      number("resolve_seconds", "Wall time to resolve.", &FrameReport::resolve_seconds),
      number("write_seconds", "Wall time to encode and write.", &FrameReport::write_seconds),
      count("pixels", "Pixels of everything that was resolved.", &FrameReport::pixels),
      count("samples", "Samples of each pixel, under --samples; else 1.",
            [](const FrameReport& r) { return std::size_t(r.samples); }),
      count("not_finite", "Pixels that were NaN or infinite and were repaired from their neighbors.",
            &FrameReport::not_finite)};
  add_vectors(fields);
  add_history(fields);
  add_light(fields);
  fields.push_back(
      text("restart", "Why the history began anew in this frame; empty if it did not.", &FrameReport::restart));
  return fields;
}

std::string property_schema(const std::string& name, FieldKind kind, const std::string& meaning) {
  return "  " + json_quote(name) + ": {" + type_of(kind) + ", \"description\": " + json_quote(meaning) + "}";
}

std::string closed_object(const std::vector<std::string>& names, const std::string& properties) {
  std::string required;
  for (const std::string& name : names) required += (required.empty() ? "" : ", ") + json_quote(name);
  return "\"type\": \"object\", \"additionalProperties\": false,\n\"required\": [" + required +
         "],\n\"properties\": {" + properties + "\n}";
}

}  // namespace varve::cli
