#include "exr/channel_names.h"

#include <algorithm>
#include <initializer_list>

#include "base/error.h"
#include "exr/channel_index.h"
#include "exr/sample_names.h"

namespace varve {
namespace {

constexpr int kMaxListed = 12;  // names in one message

constexpr std::array<std::array<std::string_view, 3>, 4> kColorBases = {
    {{"r", "red", ""}, {"g", "green", "y"}, {"b", "blue", ""}, {"a", "alpha", ""}}};

/// A group that holds a color, and how it would be called.
struct ColorLayer {
  const ChannelGroup* group = nullptr;
  std::string layer;
  int rank =
      0;  ///< what makes it the main one: 0 bare names, 1 its name, 2 Combined, 3 bare names in its part, 4 nothing
};

std::string list_text(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == kMaxListed) return text + ", and " + std::to_string(names.size() - i) + " more";
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return text;
}

std::optional<ChannelRef> color_channel(const ChannelGroup& group, std::size_t place) {
  for (const std::string_view base : kColorBases[place])
    if (!base.empty())
      if (const std::optional<ChannelRef> ref = group.find(base)) return ref;
  return std::nullopt;
}

// Does the name of the layer leave room for a color? Vectors, normals, ids and the like never are.
bool may_be_color(const ChannelGroup& group) {
  return group.file == 0 && group.holds().value_or(ChannelClass::color) == ChannelClass::color;
}

ColorLayer color_layer(const ChannelGroup& group) {
  ColorLayer found{&group, join_path(group.path), 4};
  const std::string last = group.path.empty() ? "" : lower_case(group.path.back());
  if (last == "combined") found.layer = join_path(std::span(group.path).first(group.path.size() - 1));
  const auto is = [](const std::string& name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (group.path.empty())
    found.rank = 0;
  else if (is(last, {"beauty", "rgba", "rgb", "main"}) || lower_case(found.layer) == "beauty")
    found.rank = 1;
  else if (last == "combined")
    found.rank = 2;
  else if (group.path.size() == group.part_elements)
    found.rank = 3;
  return found;
}

// Layers with R, G and B; where there is none at all, those with any of them or a luminance.
std::vector<ColorLayer> color_layers(const ChannelIndex& index) {
  std::vector<ColorLayer> found;
  for (const bool whole : {true, false}) {
    for (const ChannelGroup& group : index.groups) {
      const bool r = color_channel(group, 0).has_value(), g = color_channel(group, 1).has_value(),
                 b = color_channel(group, 2).has_value();
      if (may_be_color(group) && (whole ? r && g && b : (r || g || b) && !group.find("x")))
        found.push_back(color_layer(group));
    }
    if (!found.empty()) break;
  }
  return found;
}

// Luminance and chroma, or colors stored at every second pixel: resolving what is whole would leave the rest behind.
void refuse_subsampled_color(const ChannelIndex& index, const ChannelGroup& group) {
  for (const ChannelGroup::Member& member : group.subsampled)
    if (const ChannelClass kind = classify(index.channel(member.ref));
        may_be_color(group) && (kind == ChannelClass::color || kind == ChannelClass::alpha))
      throw Failure(ExitCode::inconsistent,
                    index.files.front().path + ": the color channel " + index.name(member.ref) +
                        " is subsampled, it has no value at every pixel; convert the file to plain RGBA first");
}

[[noreturn]] void refuse_without_color(const ChannelIndex& index) {
  for (const ChannelGroup& group : index.groups) refuse_subsampled_color(index, group);
  const FileHeader& file = index.files.front();
  std::vector<std::string> names;
  bool deep = false;
  for (const Part& part : file.parts) {
    deep = deep || is_deep(part);
    for (const Channel& channel : part.channels) names.push_back(channel.name);
  }
  throw Failure(ExitCode::inconsistent,
                file.path + ": no color channels found among " + list_text(names) +
                    (deep ? "; deep parts cannot be resolved, flatten them first"
                          : "; name them with --map R=CHANNEL, --map G=CHANNEL and --map B=CHANNEL"));
}

// Views in the order they are resolved in.
std::vector<std::string> views_to_resolve(const ChannelIndex& index, const std::vector<ColorLayer>& layers) {
  std::vector<std::string> views;
  const auto add = [&](const std::string& view) {
    const bool has_color =
        std::any_of(layers.begin(), layers.end(), [&](const ColorLayer& l) { return l.group->view == view; });
    if (has_color && std::find(views.begin(), views.end(), view) == views.end()) views.push_back(view);
  };
  for (const std::string& view : index.views) add(view);
  for (const ColorLayer& layer : layers) add(layer.group->view);
  return views;
}

/// A color chosen to be resolved, with what is to be said about the choice.
struct ChosenColor {
  ColorLayer color;
  std::string note;
};

// The main color of one view.
ChosenColor main_color(const std::vector<ColorLayer>& layers, const std::string& view) {
  const ColorLayer* best = nullptr;
  std::vector<std::string> rivals;
  for (const ColorLayer& layer : layers)
    if (layer.group->view == view && (!best || layer.rank < best->rank)) best = &layer;
  for (const ColorLayer& layer : layers)
    if (layer.group->view == view && &layer != best &&
        (layer.rank == best->rank || (best->rank > 0 && layer.rank <= 2)))
      rivals.push_back(layer.layer);
  std::string note;
  if (!rivals.empty()) {
    const std::string why = best->rank == 1   ? "its name says it is the main one"
                            : best->rank == 3 ? "it is the first part and no name says which is the main one"
                                              : "it comes first and no name says which is the main one";
    note = "color: layer " + best->layer + " is resolved, because " + why + "; there are also " + list_text(rivals) +
           "; choose with --layer NAME or --layer all";
  }
  return {*best, note};
}

bool answers_to(const ColorLayer& color, const std::string& name) {
  const std::string wanted = lower_case(name);
  return lower_case(color.layer) == wanted || lower_case(join_path(color.group->path)) == wanted;
}

std::vector<ChosenColor> choose_colors(const ChannelIndex& index, const std::vector<ColorLayer>& layers,
                                       const RoleRequest& request) {
  std::vector<ChosenColor> chosen;
  const bool combine = request.combine_layers.mode != LayersMode::apart;
  if (request.layers.empty()) {
    if (combine)
      throw Failure(ExitCode::usage,
                    "--layers composites the layers that --layer names front to back; give --layer NAME,NAME or "
                    "--layer all");
    for (const std::string& view : views_to_resolve(index, layers)) chosen.push_back(main_color(layers, view));
    return chosen;
  }
  if (request.layers.size() == 1 && request.layers.front() == "all") {
    // What is made of the layers is none of them.
    for (const ColorLayer& layer : layers)
      if (!combine || layer.rank > 1) chosen.push_back({layer, ""});
    if (chosen.empty())
      throw Failure(ExitCode::inconsistent, index.files.front().path +
                                                ": --layers has nothing to composite: there is no color layer besides "
                                                "the main one; leave --layers out");
    return chosen;
  }
  for (const std::string& name : request.layers) {
    bool found = false;
    for (const ColorLayer& layer : layers) {
      if (!answers_to(layer, name)) continue;
      found = true;
      const auto same = [&](const ChosenColor& c) { return c.color.group == layer.group; };
      if (std::none_of(chosen.begin(), chosen.end(), same)) chosen.push_back({layer, ""});
    }
    if (found) continue;
    std::vector<std::string> names;
    for (const ColorLayer& layer : layers)
      if (std::find(names.begin(), names.end(), layer.layer) == names.end())
        names.push_back(layer.layer.empty() ? "\"\" (bare RGBA)" : layer.layer);
    throw Failure(ExitCode::inconsistent, index.files.front().path + ": there is no color layer \"" + name +
                                              "\"; the color layers are " + list_text(names));
  }
  return chosen;
}

// Numbered layers.
std::vector<ChosenColor> choose_sample_colors(const ChannelIndex& index, const std::vector<ColorLayer>& layers,
                                              const RoleRequest& request) {
  std::vector<NamedLayer> names;
  for (const ColorLayer& layer : layers) names.push_back({layer.group->view, layer.layer});
  const ChosenSamples samples = choose_samples(names, request.layers, index.files.front().path);
  std::vector<ChosenColor> chosen;
  for (const std::size_t place : samples.layers) chosen.push_back({layers[place], chosen.empty() ? samples.note : ""});
  return chosen;
}

// Every channel that holds a depth by its name. Ray distances (Denoising Depth), positions and vectors with a Z are
// none.
std::vector<RoleCandidate> depth_candidates(const ChannelIndex& index) {
  std::vector<RoleCandidate> found;
  for (const ChannelGroup& group : index.groups) {
    const std::optional<ChannelClass> holds = group.holds();
    if (holds == ChannelClass::depth) {
      int quality = 0;
      for (const std::string_view base : {"z", "v", "depth", "r", "y", "x"}) {
        if (const std::optional<ChannelRef> ref = group.find(base))
          found.push_back({&group, group.path.size() - 1, quality, *ref, *ref});
        ++quality;
      }
      continue;
    }
    if (holds && holds != ChannelClass::color) continue;
    const bool has_color = color_channel(group, 0) || color_channel(group, 1) || color_channel(group, 2);
    const bool bare = group.path.size() == group.part_elements;
    const bool vector = group.find("x") && group.find("y");
    int quality = 0;
    for (const std::string_view base : {"z", "depth", "zdepth"}) {
      const std::optional<ChannelRef> ref = group.find(base);
      if (ref && !(base == "z" && (vector || (!has_color && !bare))))
        found.push_back({&group, group.path.size(), quality, *ref, *ref});
      ++quality;
    }
  }
  return found;
}

void find_depth(const ChannelIndex& index, const ColorLayer& color, const RoleRequest& request, Subject& subject) {
  subject.depth = mapped_channel(index, request, "depth", color.group->part);
  if (subject.depth) {
    subject.notes.push_back("depth: " + index.name(*subject.depth) + ", as given");
    return;
  }
  const std::vector<RoleCandidate> candidates = depth_candidates(index);
  const std::optional<RoleChoice> choice = choose_role(index, *color.group, color.rank <= 1, candidates);
  if (!choice) {
    subject.notes.push_back("depth: none found by name" + (subject.layer.empty() ? "" : " for layer " + subject.layer) +
                            "; name it with --map depth=CHANNEL if there is one");
    return;
  }
  subject.depth = choice->candidate.x;
  subject.notes.push_back("depth: " + index.name(*subject.depth) + ", told by its name" +
                          (choice->foreign ? "; it is the only depth there is, though not of this layer" : ""));
}

// A color given channel by channel with --map; the layer is where its first channel lies.
std::optional<ColorLayer> mapped_color(const ChannelIndex& index, const RoleRequest& request) {
  for (const std::string_view role : {"R", "G", "B"}) {
    const std::optional<ChannelRef> ref = mapped_channel(index, request, role, 0);
    if (!ref) continue;
    for (const ChannelGroup& group : index.groups)
      for (const ChannelGroup::Member& member : group.members)
        if (member.ref == *ref) return ColorLayer{&group, join_path(group.path), 1};
  }
  return std::nullopt;
}

Subject make_subject(const ChannelIndex& index, const ChosenColor& chosen, bool mapped, const RoleRequest& request) {
  const ChannelGroup& group = *chosen.color.group;
  Subject subject;
  subject.layer = chosen.color.layer;
  subject.view = group.view;
  subject.default_view = group.view.empty() || index.views.empty() || group.view == index.views.front();
  constexpr std::array<std::string_view, 4> kRoles = {"R", "G", "B", "A"};
  std::string names;
  for (std::size_t i = 0; i < 4; ++i) {
    subject.color[i] = mapped_channel(index, request, kRoles[i], group.part);
    if (subject.color[i] && subject.color[i]->file != 0)
      throw Failure(ExitCode::inconsistent, "--map " + std::string(kRoles[i]) + ": " + index.name(*subject.color[i]) +
                                                " is not in the color file; color is taken from the first file only");
    if (!subject.color[i] && (!mapped || i == 3)) subject.color[i] = color_channel(group, i);
    if (subject.color[i]) names += (names.empty() ? "" : ", ") + index.name(*subject.color[i]);
  }
  for (const std::optional<ChannelRef>& channel : subject.color)
    if (channel && channel->part != group.part)
      throw Failure(ExitCode::inconsistent, "the color channels " + names +
                                                " lie in different parts; map R, G, B and A "
                                                "to channels of one part");
  const auto count =
      std::count_if(subject.color.begin(), subject.color.begin() + 3, [](const auto& c) { return c.has_value(); });
  if (count < 3) subject.notes.push_back("color: only " + names + " found, resolved as it is");
  if (!chosen.note.empty()) subject.notes.push_back(chosen.note);
  for (const ChannelGroup& other : index.groups)
    for (const ChannelGroup::Member& member : other.subsampled)
      if (const ChannelClass kind = classify(index.channel(member.ref));
          kind == ChannelClass::depth || kind == ChannelClass::motion)
        subject.notes.push_back(index.name(member.ref) +
                                " is subsampled, it has no value at every pixel, and is not used");
  return subject;
}

void check_role_names(const RoleRequest& request) {
  constexpr std::string_view kKnown[] = {"R",        "G",        "B",         "A",         "depth",
                                         "motion.x", "motion.y", "forward.x", "forward.y", "id",
                                         "normal.x", "normal.y", "normal.z",  "reactive",  "responsive"};
  for (const auto& [role, channel] : request.map)
    if (std::find(std::begin(kKnown), std::end(kKnown), role) == std::end(kKnown))
      throw Failure(ExitCode::usage, "--map " + role + "=" + channel +
                                         ": unknown role; the roles are R, G, B, A, depth, motion.x, motion.y, "
                                         "forward.x, forward.y, id, normal.x, normal.y, normal.z, reactive and "
                                         "responsive");
}

}  // namespace

std::vector<Subject> find_subjects(std::span<const FileHeader> files, const RoleRequest& request) {
  check_role_names(request);
  if (files.empty()) throw Failure(ExitCode::inconsistent, "there is no file to look for color in");
  const ChannelIndex index = index_channels(files);
  std::vector<ChosenColor> chosen;
  const std::optional<ColorLayer> mapped = mapped_color(index, request);
  if (mapped) {
    chosen.push_back({*mapped, "color: as given with --map"});
  } else {
    const std::vector<ColorLayer> layers = color_layers(index);
    if (layers.empty()) refuse_without_color(index);
    const bool numbered = request.samples.mode != SampleMode::off && request.samples.grid == 0;
    chosen = numbered ? choose_sample_colors(index, layers, request) : choose_colors(index, layers, request);
    for (const ChosenColor& color : chosen) refuse_subsampled_color(index, *color.color.group);
  }
  std::vector<Subject> subjects;
  for (const ChosenColor& color : chosen) {
    Subject subject = make_subject(index, color, mapped.has_value(), request);
    find_depth(index, color.color, request, subject);
    find_motion(index, *color.color.group, color.color.rank <= 1, request, subject);
    find_marks(index, *color.color.group, color.color.rank <= 1, request, subject);
    find_transmittance(index, *color.color.group, request.combine_layers, subject);
    subjects.push_back(std::move(subject));
  }
  add_channels(index, request, subjects);
  for (Subject& subject : subjects) {
    subject.place.part = part_of(subject);
    for (std::size_t k = 0; k < 4; ++k)
      if (subject.color[k]) subject.place.channels[k] = index.channel(*subject.color[k]);
  }
  return subjects;
}

std::optional<MainColor> main_color_beside(const ChannelIndex& index, const std::string& view,
                                           std::span<const Subject> subjects) {
  std::optional<ColorLayer> best;
  for (const ColorLayer& layer : color_layers(index)) {
    const std::optional<ChannelRef> red = color_channel(*layer.group, 0);
    const bool used =
        std::any_of(subjects.begin(), subjects.end(), [&](const Subject& s) { return s.color[0] == red; });
    if (layer.group->view == view && layer.rank <= 1 && !used && (!best || layer.rank < best->rank)) best = layer;
  }
  if (!best) return std::nullopt;
  MainColor main{best->layer, {best->group->part, {}}};
  for (std::size_t k = 0; k < 4; ++k)
    if (const std::optional<ChannelRef> ref = color_channel(*best->group, k))
      main.place.channels[k] = index.channel(*ref);
  return main;
}

}  // namespace varve
