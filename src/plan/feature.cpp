#include "plan/feature.h"

namespace varve {

std::string feature_name(const Feature& feature) {
  const std::string number = std::to_string(feature.number);
  if (feature.group == FeatureGroup::system) return "system " + number;
  return feature.group == FeatureGroup::beyond ? "beyond " + number : number;
}

std::string_view reach_name(Reach reach) {
  switch (reach) {
    case Reach::option:
      return "Reached by";
    case Reach::built_in:
      return "Always";
    case Reach::renderer:
      return "Of the renderer";
    case Reach::planned:
      return "Planned";
  }
  return "";
}

}  // namespace varve
