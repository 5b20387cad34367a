// What names say about content: the alias table of layers, and the class of a single channel.

#include <algorithm>
#include <array>
#include <string_view>

#include "exr/channel_index.h"

namespace varve {
namespace {

struct LayerAlias {
  std::string_view name;  // lower case
  ChannelClass holds;
};

// Layer names seen in files and in documentation, plus the words themselves.
constexpr LayerAlias kLayers[] = {
    {"combined", ChannelClass::color},
    {"rgba", ChannelClass::color},
    {"rgb", ChannelClass::color},
    {"beauty", ChannelClass::color},
    {"transmittance", ChannelClass::alpha},
    {"depth", ChannelClass::depth},
    {"z", ChannelClass::depth},
    {"zdepth", ChannelClass::depth},
    {"pz", ChannelClass::depth},
    {"vector", ChannelClass::motion},
    {"velocity", ChannelClass::motion},
    {"motion", ChannelClass::motion},
    {"motionvector", ChannelClass::motion},
    {"motionvectors", ChannelClass::motion},
    {"motionvec", ChannelClass::motion},
    {"mv", ChannelClass::motion},
    {"mv2n", ChannelClass::motion},
    {"forward", ChannelClass::motion},
    {"backward", ChannelClass::motion},
    {"backvector", ChannelClass::motion},
    {"vel", ChannelClass::motion},
    {"normal", ChannelClass::normal},
    {"normals", ChannelClass::normal},
    {"n", ChannelClass::normal},
    {"denoising normal", ChannelClass::normal},
    {"position", ChannelClass::position},
    {"p", ChannelClass::position},
    {"pos", ChannelClass::position},
    {"pref", ChannelClass::position},
    {"uv", ChannelClass::uv},
    {"st", ChannelClass::uv},
    {"id", ChannelClass::id},
    {"objectid", ChannelClass::id},
    {"materialid", ChannelClass::id},
    {"indexob", ChannelClass::id},
    {"indexma", ChannelClass::id},
    {"object_id", ChannelClass::id},
    {"material_id", ChannelClass::id},
    {"instanceid", ChannelClass::id},
    {"mist", ChannelClass::other},
    {"denoising depth", ChannelClass::other},
    {"debug sample count", ChannelClass::other},
};

bool any_of(std::string_view text, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), text) != names.end();
}

ChannelClass class_of_base(const std::string& base) {
  if (any_of(base, {"r", "g", "b", "red", "green", "blue", "ry", "by"})) return ChannelClass::color;
  if (any_of(base, {"a", "alpha", "ar", "ag", "ab", "ra", "ga", "ba", "tr", "tg", "tb"})) return ChannelClass::alpha;
  if (any_of(base, {"z", "zback", "depth", "zdepth"})) return ChannelClass::depth;
  if (any_of(base, {"velx", "vely"})) return ChannelClass::motion;
  return class_of_layer(base).value_or(ChannelClass::other);
}

}  // namespace

std::optional<ChannelClass> class_of_layer(std::string_view element) {
  const std::string name = lower_case(element);
  if (name.starts_with("crypto") || name.find("cryptomatte") != std::string::npos) return ChannelClass::cryptomatte;
  for (const LayerAlias& alias : kLayers)
    if (alias.name == name) return alias.holds;
  return std::nullopt;
}

ChannelClass classify(const Channel& channel) {
  const std::vector<std::string> elements = split_at_dots(channel.name);
  for (const std::string& element : elements)
    if (class_of_layer(element) == ChannelClass::cryptomatte) return ChannelClass::cryptomatte;
  if (channel.type == PixelType::uint32) return ChannelClass::id;
  const ChannelClass base = class_of_base(lower_case(elements.back()));
  // The layer nearest the channel that says something decides; a view or a pass name nobody knows may lie between.
  for (auto element = elements.rbegin() + 1; element != elements.rend(); ++element)
    if (const std::optional<ChannelClass> holds = class_of_layer(*element))
      return *holds == ChannelClass::color ? base : *holds;
  // A plain Y is a luminance; below a layer that says nothing it is the second of some vector.
  return elements.size() == 1 && elements[0] == "Y" ? ChannelClass::color : base;
}

const char* name_of(ChannelClass channel_class) {
  switch (channel_class) {
    case ChannelClass::color:
      return "color";
    case ChannelClass::alpha:
      return "alpha";
    case ChannelClass::depth:
      return "depth";
    case ChannelClass::motion:
      return "motion";
    case ChannelClass::normal:
      return "normal";
    case ChannelClass::position:
      return "position";
    case ChannelClass::uv:
      return "uv";
    case ChannelClass::id:
      return "id";
    case ChannelClass::cryptomatte:
      return "cryptomatte";
    case ChannelClass::other:
      break;
  }
  return "other";
}

}  // namespace varve
