// Vectors by name, and what they mean by convention. Nothing is guessed: a layer that only looks like motion stops the
// run.

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/words.h"
#include "exr/channel_index.h"
#include "exr/unknown_convention.h"

namespace varve {
namespace {

constexpr std::string_view kRemedy =
    "give --convention NAME (see varve help conventions), or --convention none to resolve without vectors";

bool ends_with(const std::vector<std::string>& path, const std::vector<std::string>& tail) {
  return path.size() >= tail.size() &&
         std::equal(tail.begin(), tail.end(), path.end() - std::ptrdiff_t(tail.size()),
                    [](const std::string& a, const std::string& b) { return lower_case(a) == lower_case(b); });
}

// Every pair of channels called (x, y) in the layers of a row of the table.
std::vector<RoleCandidate> vector_candidates(const ChannelIndex& index, std::string_view layers, std::string_view x,
                                             std::string_view y) {
  std::vector<RoleCandidate> found;
  if (x.empty()) return found;
  std::vector<std::string> x_path = split_at_dots(lower_case(x)), y_path = split_at_dots(lower_case(y));
  const std::string x_base = x_path.back(), y_base = y_path.back();
  x_path.pop_back();
  std::vector<std::vector<std::string>> tails;
  if (!x_path.empty() || layers.empty())
    tails.push_back(x_path);
  else
    for (const std::string_view layer : split_at_commas(layers)) tails.push_back({std::string(layer)});
  for (const ChannelGroup& group : index.groups)
    for (std::size_t t = 0; t < tails.size(); ++t) {
      const std::optional<ChannelRef> ref_x = group.find(x_base), ref_y = group.find(y_base);
      if (ref_x && ref_y && ends_with(group.path, tails[t]))
        found.push_back({&group, group.path.size() - tails[t].size(), int(t), *ref_x, *ref_y});
    }
  return found;
}

// Layers that look like motion, whatever their convention: at least two channels under a name used for vectors.
std::vector<RoleCandidate> velocity_like(const ChannelIndex& index) {
  std::vector<RoleCandidate> found;
  for (const ChannelGroup& group : index.groups) {
    std::vector<ChannelRef> members;
    for (const ChannelGroup::Member& member : group.members)
      if (member.type != PixelType::uint32 && classify(index.channel(member.ref)) == ChannelClass::motion)
        members.push_back(member.ref);
    const bool by_layer = group.holds() == ChannelClass::motion;
    if (by_layer && members.empty())  // the name of the part says it
      for (const ChannelGroup::Member& member : group.members) members.push_back(member.ref);
    if (members.size() >= 2)
      found.push_back({&group, group.path.size() - (by_layer ? 1 : 0), 0, members[0], members[1]});
  }
  return found;
}

/// The vectors of one layer in one convention.
struct FoundVectors {
  std::optional<RoleChoice> backward, forward;
  explicit operator bool() const { return backward || forward; }
};

FoundVectors vectors_of_row(const ChannelIndex& index, const ChannelGroup& color, bool main_color,
                            const MotionConvention& row) {
  const auto best = [&](std::string_view x, std::string_view y) {
    return choose_role(index, color, main_color, vector_candidates(index, row.layers, x, y));
  };
  return {best(row.backward_x, row.backward_y), best(row.forward_x, row.forward_y)};
}

// What the file itself says: the attribute varve:motion holds the name of a convention.
const MotionConvention* told_by_attribute(const ChannelIndex& index, const ChannelGroup& color) {
  const FileHeader& file = index.files[std::size_t(color.file)];
  const Attribute* attribute = file.parts[std::size_t(color.part)].attribute("varve:motion");
  if (!attribute) return nullptr;
  if (const MotionConvention* row = find_motion_convention(attribute->text)) return row;
  throw Failure(ExitCode::inconsistent, file.path + ": the attribute varve:motion names the convention \"" +
                                            attribute->text + "\", which is unknown: " + std::string(kRemedy));
}

// Conventions that names alone tell: all four channels of a Vector layer, or u and v under forward or backward.
std::pair<const MotionConvention*, FoundVectors> told_by_names(const ChannelIndex& index, const ChannelGroup& color,
                                                               bool main_color) {
  const MotionConvention* cycles = find_motion_convention("cycles");
  if (FoundVectors found = vectors_of_row(index, color, main_color, *cycles);
      found.backward && found.forward && found.backward->candidate.group == found.forward->candidate.group)
    return {cycles, found};
  const MotionConvention* nuke = find_motion_convention("nuke");
  if (FoundVectors found = vectors_of_row(index, color, main_color, *nuke)) return {nuke, found};
  return {nullptr, {}};
}

std::string names_of(const ChannelIndex& index, const ChannelGroup& group) {
  std::string text;
  for (const ChannelGroup::Member& member : group.members) {
    if (text.size() > 200) return text + ", ...";
    text += (text.empty() ? "" : ", ") + index.name(member.ref);
  }
  return text;
}

MotionEncoding with_overrides(MotionEncoding encoding, const RoleRequest& request) {
  if (request.override_bias) encoding.bias = request.encoding.bias;
  if (request.override_scale) encoding.scale = request.encoding.scale;
  if (request.override_shutter) encoding.shutter = request.encoding.shutter;
  if (request.override_sign_x) encoding.sign_x = request.encoding.sign_x;
  if (request.override_sign_y) encoding.sign_y = request.encoding.sign_y;
  if (request.override_unit) encoding.unit = request.encoding.unit;
  return encoding;
}

// What the user said about the encoding goes over what the row says. A direction given by hand leaves one vector: the
// row's own for that direction, or the other one read as that direction.
void apply_overrides(const RoleRequest& request, Subject& subject) {
  subject.backward_encoding = with_overrides(subject.backward_encoding, request);
  subject.forward_encoding = with_overrides(subject.forward_encoding, request);
  if (!request.override_direction) return;
  const bool previous = request.encoding.direction == MotionDirection::previous;
  std::optional<VectorChannels>& kept = previous ? subject.backward : subject.forward;
  std::optional<VectorChannels>& other = previous ? subject.forward : subject.backward;
  if (!kept && other) {
    kept = other;
    (previous ? subject.backward_encoding : subject.forward_encoding) =
        previous ? subject.forward_encoding : subject.backward_encoding;
  }
  other.reset();
  (previous ? subject.backward_encoding : subject.forward_encoding).direction = request.encoding.direction;
}

// Encoding of a row for one direction; rows that know only the other direction lend theirs, for the role says the
// direction.
MotionEncoding encoding_for(const MotionConvention& row, MotionDirection direction) {
  const bool previous = direction == MotionDirection::previous;
  const bool has_own = !(previous ? row.backward_x : row.forward_x).empty();
  MotionEncoding encoding = previous == has_own ? row.backward : row.forward;
  encoding.direction = direction;
  return encoding;
}

std::optional<VectorChannels> mapped_vector(const ChannelIndex& index, const RoleRequest& request,
                                            const std::string& role, int part) {
  const std::optional<ChannelRef> x = mapped_channel(index, request, role + ".x", part);
  const std::optional<ChannelRef> y = mapped_channel(index, request, role + ".y", part);
  if (x.has_value() != y.has_value())
    throw Failure(ExitCode::inconsistent, "--map " + role + ".x and --map " + role + ".y must be given together");
  if (!x) return std::nullopt;
  return VectorChannels{*x, *y};
}

void set_convention(const MotionConvention& row, Subject& subject) {
  subject.convention = row.name;
  subject.background_depth = row.background_depth;
  subject.backward_encoding = encoding_for(row, MotionDirection::previous);
  subject.forward_encoding = encoding_for(row, MotionDirection::next);
}

const MotionConvention* named_row(const RoleRequest& request) {
  if (request.convention == "auto" || request.convention == "none") return nullptr;
  const MotionConvention* row = find_motion_convention(request.convention);
  if (!row)
    throw Failure(ExitCode::usage, "--convention " + request.convention +
                                       ": there is no such convention; varve help conventions lists them");
  return row;
}

// Vectors named by --map. Returns false when none were.
bool use_mapped(const ChannelIndex& index, const ChannelGroup& color, const RoleRequest& request,
                const MotionConvention* row, Subject& subject) {
  subject.backward = mapped_vector(index, request, "motion", color.part);
  subject.forward = mapped_vector(index, request, "forward", color.part);
  if (!subject.backward && !subject.forward) return false;
  const VectorChannels& shown = subject.backward ? *subject.backward : *subject.forward;
  if (!row)
    throw Failure(ExitCode::inconsistent,
                  "the vectors " + index.name(shown[0]) + " and " + index.name(shown[1]) +
                      " are given with --map, but not their convention: " + std::string(kRemedy));
  set_convention(*row, subject);
  return true;
}

void note_found(const ChannelIndex& index, const MotionConvention& row, const FoundVectors& found,
                const std::string& evidence, Subject& subject) {
  for (const bool backward : {true, false}) {
    const std::optional<RoleChoice>& choice = backward ? found.backward : found.forward;
    if (!choice) continue;
    const RoleCandidate& c = choice->candidate;
    (backward ? subject.backward : subject.forward) = VectorChannels{c.x, c.y};
    std::string note = "motion to the " + std::string(backward ? "previous" : "next") + " frame: " + index.name(c.x) +
                       ", " + index.name(c.y) + ", convention " + std::string(row.name) + ", " + evidence;
    if (choice->foreign) note += "; they are the only vectors there are, though not of this layer";
    subject.notes.push_back(note);
  }
  if (row.evidence != Evidence::measured)
    subject.notes.push_back("convention " + std::string(row.name) + " is " +
                            (row.evidence == Evidence::documented ? "documented, not measured: " : "not verified: ") +
                            std::string(row.note));
}

}  // namespace

void find_motion(const ChannelIndex& index, const ChannelGroup& color, bool main_color, const RoleRequest& request,
                 Subject& subject) {
  const MotionConvention* row = named_row(request);
  if (request.convention == "none") {
    subject.notes.push_back("motion: vectors are not used, as asked by --convention none");
    return;
  }
  if (use_mapped(index, color, request, row, subject)) {
    apply_overrides(request, subject);
    return;
  }
  FoundVectors found;
  std::string evidence = "as given";
  if (row)
    found = vectors_of_row(index, color, main_color, *row);
  else if (row = told_by_attribute(index, color); row) {
    found = vectors_of_row(index, color, main_color, *row);
    evidence = "told by the attribute varve:motion";
  } else {
    std::tie(row, found) = told_by_names(index, color, main_color);
    evidence = "told by the channel names";
  }
  if (row && found) {
    set_convention(*row, subject);
    note_found(index, *row, found, evidence, subject);
    apply_overrides(request, subject);
    return;
  }
  const std::optional<RoleChoice> unknown = choose_role(index, color, main_color, velocity_like(index));
  const std::string layer = subject.layer.empty() ? "the main layer" : "layer " + subject.layer;
  if (unknown && request.convention == "auto")
    throw UnknownConvention("the channels " + names_of(index, *unknown->candidate.group) + " look like the motion of " +
                            layer +
                            ", but their names do not tell which convention they follow: " + std::string(kRemedy));
  if (unknown)
    throw Failure(ExitCode::inconsistent,
                  "convention " + request.convention + " does not have the channels " +
                      names_of(index, *unknown->candidate.group) + " of " + layer +
                      "; name the vectors with --map motion.x=CHANNEL and --map motion.y=CHANNEL");
  subject.notes.push_back(
      "motion: no vectors found for " + layer + "; history is taken from the same pixel, which suits only what rests" +
      (request.convention == "auto" ? "" : " (convention " + request.convention + " was asked for)"));
}

}  // namespace varve
