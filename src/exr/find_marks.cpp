// What tells surfaces apart: the id and the normal of a subject, and the masks a user maps.

#include <array>

#include "base/error.h"
#include "exr/channel_index.h"

namespace varve {
namespace {

// The channel of that base name, integers included.
std::optional<ChannelRef> find_any(const ChannelGroup& group, std::string_view base) {
  for (const ChannelGroup::Member& member : group.members)
    if (member.base == base) return member.ref;
  return std::nullopt;
}

// An object tells surfaces apart better than a material, which many share; hashes of a Cryptomatte come last, since
// their first rank is that of the object that covers most of the pixel, not of the one in front.
int id_quality(std::string_view name) {
  if (name.find("ma") == std::string_view::npos) return 0;
  return 1;  // indexma, materialid, material_id
}

// Every channel that holds an identity by its name.
std::vector<RoleCandidate> id_candidates(const ChannelIndex& index) {
  std::vector<RoleCandidate> found;
  for (const ChannelGroup& group : index.groups) {
    const std::optional<ChannelClass> holds = group.holds();
    const std::string last = group.path.empty() ? "" : lower_case(group.path.back());
    if (holds == ChannelClass::id) {
      if (group.members.size() == 1)
        found.push_back({&group, group.path.size() - 1, id_quality(last), group.members.front().ref, {}});
    } else if (holds == ChannelClass::cryptomatte) {
      // Layers NAME00, NAME01, ...: the first two ranks are in 00, the first hash in its red.
      for (const std::string_view base : {"r", "red"})
        if (const std::optional<ChannelRef> ref = group.find(base); ref && last.ends_with("00"))
          found.push_back({&group, group.path.size() - 1, last.find("object") != std::string::npos ? 2 : 3, *ref, {}});
    } else if (!holds || holds == ChannelClass::color) {
      for (const std::string_view base :
           {"id", "objectid", "object_id", "indexob", "instanceid", "materialid", "material_id", "indexma"})
        if (const std::optional<ChannelRef> ref = find_any(group, base))
          found.push_back({&group, group.path.size(), id_quality(base), *ref, {}});
    }
  }
  return found;
}

// Every layer that holds a normal by its name, three axes each.
std::vector<RoleCandidate> normal_candidates(const ChannelIndex& index) {
  constexpr std::array<std::array<std::string_view, 3>, 2> kAxes = {{{"x", "y", "z"}, {"r", "g", "b"}}};
  std::vector<RoleCandidate> found;
  const auto add = [&](const ChannelGroup& group, const std::array<std::string_view, 3>& bases, std::size_t owner) {
    const auto x = group.find(bases[0]), y = group.find(bases[1]), z = group.find(bases[2]);
    if (!x || !y || !z) return;
    // A denoiser's normal is that of what is seen in a mirror or through glass.
    const bool plain = group.path.empty() || lower_case(group.path.back()).find("denois") == std::string::npos;
    found.push_back({&group, owner, plain ? 0 : 1, *x, *y, *z});
  };
  for (const ChannelGroup& group : index.groups) {
    const std::optional<ChannelClass> holds = group.holds();
    if (holds == ChannelClass::normal)
      for (const auto& bases : kAxes) add(group, bases, group.path.size() - 1);
    else if (!holds || holds == ChannelClass::color)
      add(group, {"nx", "ny", "nz"}, group.path.size());
  }
  return found;
}

std::optional<NormalChannels> mapped_normal(const ChannelIndex& index, const RoleRequest& request, int part) {
  constexpr std::array<std::string_view, 3> kRoles = {"normal.x", "normal.y", "normal.z"};
  NormalChannels normal;
  std::size_t mapped = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (const std::optional<ChannelRef> ref = mapped_channel(index, request, kRoles[i], part))
      normal[i] = *ref, ++mapped;
  if (mapped == 0) return std::nullopt;
  if (mapped < 3)
    throw Failure(ExitCode::inconsistent,
                  "--map: a normal has three channels; name normal.x, normal.y and normal.z, or none of them");
  return normal;
}

}  // namespace

void find_marks(const ChannelIndex& index, const ChannelGroup& color, bool main_color, const RoleRequest& request,
                Subject& subject) {
  subject.reactive = mapped_channel(index, request, "reactive", color.part);
  subject.responsive = mapped_channel(index, request, "responsive", color.part);
  subject.id = mapped_channel(index, request, "id", color.part, true);
  if (!subject.id)
    if (const auto choice = choose_role(index, color, main_color, id_candidates(index)))
      subject.id = choice->candidate.x;
  subject.normal = mapped_normal(index, request, color.part);
  if (!subject.normal)
    if (const auto choice = choose_role(index, color, main_color, normal_candidates(index)))
      subject.normal = NormalChannels{choice->candidate.x, choice->candidate.y, choice->candidate.z};
}

}  // namespace varve
