// The rows of --report, field by field: one table writes them, describes them and makes their schema.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "resolve_sequence.h"

namespace varve::cli {

/// What a value may be.
enum class FieldKind {
  text,
  texts,
  flag,
  integer,
  count,           ///< a whole number, 0 and up
  number,          ///< 0 and up
  number_or_null,  ///< null where there is nothing to measure
};

template <class T>
struct ReportField {
  std::string name;
  FieldKind kind;
  std::string meaning;                         ///< a sentence
  std::function<std::string(const T&)> value;  ///< as JSON
};

/// Everything that a frame's row holds, in order. Names and kinds stay as they are as long as the schema keeps its
/// number; fields may be added under the next one.
std::vector<ReportField<FrameReport>> frame_fields();

template <class T>
std::string object_text(const std::vector<ReportField<T>>& fields, const T& from);

/// "{"type":"object", ...}" of JSON Schema: every field is required and no other is allowed.
template <class T>
std::string object_schema(const std::vector<ReportField<T>>& fields);

/// One member of a schema's "properties".
std::string property_schema(const std::string& name, FieldKind kind, const std::string& meaning);
/// The rest of an object's schema around its properties.
std::string closed_object(const std::vector<std::string>& names, const std::string& properties);

template <class T>
std::string object_text(const std::vector<ReportField<T>>& fields, const T& from) {
  std::string text;
  for (const ReportField<T>& field : fields)
    text += (text.empty() ? "{\"" : ",\"") + field.name + "\":" + field.value(from);
  return text + "}";
}

template <class T>
std::string object_schema(const std::vector<ReportField<T>>& fields) {
  std::vector<std::string> names;
  std::string properties;
  for (const ReportField<T>& field : fields) {
    names.push_back(field.name);
    properties += (properties.empty() ? "\n" : ",\n") + property_schema(field.name, field.kind, field.meaning);
  }
  return closed_object(names, properties);
}

}  // namespace varve::cli
