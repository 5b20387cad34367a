// What is written, and which subjects it is made from.

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "exr/channel_index.h"

namespace varve {
namespace {

constexpr std::string_view kPlaceNames = "RGBA";

/// Layers of one view, front to back.
struct Stack {
  std::string view;
  std::vector<std::size_t> layers;
};

std::vector<Stack> stacks_of(std::span<const Subject> subjects) {
  std::vector<Stack> stacks;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const auto same = [&](const Stack& s) { return s.view == subjects[i].view; };
    auto stack = std::find_if(stacks.begin(), stacks.end(), same);
    if (stack == stacks.end()) stack = stacks.insert(stacks.end(), {subjects[i].view, {}});
    stack->layers.push_back(i);
  }
  return stacks;
}

/// By name, runs of digits as numbers: layer.2 before layer.10.
bool before_by_name(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto number = [&](const std::string& text, std::size_t& at) {  // without zeros in front
    while (at < text.size() && text[at] == '0') ++at;
    const std::size_t begin = at;
    while (at < text.size() && digit(text[at])) ++at;
    return text.substr(begin, at - begin);
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      const std::string m = number(a, i), n = number(b, j);
      if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
      continue;
    }
    if (a[i] != b[j]) return a[i] < b[j];
    ++i, ++j;
  }
  return a.size() - i < b.size() - j;
}

std::string names_of(std::span<const Subject> subjects, const Stack& stack) {
  std::string names;
  for (const std::size_t i : stack.layers)
    names += (names.empty() ? "" : ", ") + (subjects[i].layer.empty() ? "\"\"" : subjects[i].layer);
  return names;
}

/// Bare R G B A beside the channels of the first layer whose part has data wherever some layer has; float if the layer
/// is, below "composite" where the part has bare ones already. Throws where no part has room for all.
ColorPlace new_place(std::span<const FileHeader> files, std::span<const Subject> subjects, const Stack& stack) {
  const auto window = [&](std::size_t i) { return files.front().parts[std::size_t(part_of(subjects[i]))].data_window; };
  Window all;
  for (const std::size_t i : stack.layers) all = unite(all, window(i));
  const auto whole = std::find_if(stack.layers.begin(), stack.layers.end(), [&](auto i) { return window(i) == all; });
  if (whole == stack.layers.end())
    throw Failure(ExitCode::inconsistent,
                  "no data window of the layers " + names_of(subjects, stack) +
                      " holds all of them, so there is no part to write what they make together to; widen that of one "
                      "layer to hold the others, as oiiotool -a --croptofull does");
  const Subject& front = subjects[*whole];
  ColorPlace place{part_of(front), {}};
  const Part& part = files.front().parts[std::size_t(place.part)];
  const std::string view = front.default_view || front.view.empty() ? "" : front.view + ".";
  const auto taken = [&](const std::string& prefix) {
    return std::any_of(kPlaceNames.begin(), kPlaceNames.end(),
                       [&](char name) { return part.channel(prefix + name).has_value(); });
  };
  const std::string prefix = taken(view) ? "composite." + view : view;
  PixelType type = PixelType::float16;
  for (const auto& channel : front.place.channels)
    if (channel && channel->type == PixelType::float32) type = PixelType::float32;
  for (std::size_t k = 0; k < 4; ++k) place.channels[k] = {prefix + kPlaceNames[k], type, 1, 1, false};
  return place;
}

const char* order_text(LayerOrder order) {
  switch (order) {
    case LayerOrder::list:
      return "in the order of --layer";
    case LayerOrder::depth:
      return "by depth";
    case LayerOrder::name:
      return "by name";
  }
  return "";
}

ColorOutput composite_output(const ChannelIndex& index, std::span<const Subject> subjects, const Stack& stack,
                             const LayersRequest& request) {
  ColorOutput output;
  const Subject& front = subjects[stack.layers.front()];
  Subject& s = output.subject;
  s.view = front.view;
  s.default_view = front.default_view;
  s.color = front.color;
  output.inputs = stack.layers;
  output.combine = Combine::layers;
  output.after = request.mode == LayersMode::each;
  output.write_inputs = request.write;
  if (std::optional<MainColor> main = main_color_beside(index, front.view, subjects)) {
    s.layer = main->layer;
    s.place = std::move(main->place);
    s.notes.push_back("layers: the composite is written in the place of " +
                      (s.layer.empty() ? "the bare R G B A" : s.layer));
  } else {
    s.place = new_place(index.files, subjects, stack);
    s.notes.push_back("layers: no color of the file is the composite of all layers, so " + s.place.channels[0]->name +
                      ", " + s.place.channels[1]->name + ", " + s.place.channels[2]->name + " and " +
                      s.place.channels[3]->name + " are added for it");
  }
  s.notes.push_back("layers: composited front to back as " + names_of(subjects, stack) + ", " +
                    order_text(request.order));
  for (const std::size_t i : stack.layers) {
    const Subject& layer = subjects[i];
    s.companions.insert(s.companions.end(), layer.companions.begin(), layer.companions.end());
  }
  return output;
}

/// And, to be compared with it, what the other mode makes of the same layers.
void add_composite(ColorOutput output, const LayersRequest& request, std::vector<ColorOutput>& outputs) {
  outputs.push_back(std::move(output));
  if (!request.difference) return;
  ColorOutput other = outputs.back();
  other.after = !other.after;
  other.only_compared = true;
  other.subject.notes.clear();
  outputs.push_back(std::move(other));
}

}  // namespace

std::vector<ColorOutput> color_outputs(std::span<const FileHeader> files, std::span<const Subject> subjects,
                                       const RoleRequest& request) {
  std::vector<ColorOutput> outputs;
  if (request.combine_layers.mode == LayersMode::apart) {
    for (const Subject& subject : subjects) outputs.push_back({subject, {outputs.size()}});
    return outputs;
  }
  if (!request.channels.empty() && request.channel_weights == ChannelWeights::own)
    throw Failure(ExitCode::usage,
                  "--channel-weights own makes colors of --channels, which --layers would take for layers; give "
                  "--channel-weights beauty, or leave --layers out");
  const bool deep = std::any_of(subjects.begin(), subjects.end(), [&](const Subject& subject) {
    return is_deep(files.front().parts[std::size_t(part_of(subject))]);
  });
  const ChannelIndex index = index_channels(files, deep);
  std::vector<Stack> stacks = stacks_of(subjects);
  if (request.combine_layers.order == LayerOrder::name)
    for (Stack& stack : stacks)
      std::stable_sort(stack.layers.begin(), stack.layers.end(), [&](std::size_t a, std::size_t b) {
        return before_by_name(subjects[a].layer, subjects[b].layer);
      });
  for (const Stack& stack : stacks)
    if (stack.layers.size() == 1)  // nothing to composite
      outputs.push_back({subjects[stack.layers.front()], stack.layers});
    else
      add_composite(composite_output(index, subjects, stack, request.combine_layers), request.combine_layers, outputs);
  return outputs;
}

std::vector<const Subject*> accumulated_subjects(std::span<const ColorOutput> outputs,
                                                 std::span<const Subject> subjects) {
  std::vector<const Subject*> accumulated;
  for (const ColorOutput& output : outputs) {
    if (!output.after) accumulated.push_back(&output.subject);
    for (std::size_t i = 0; output.after && i < output.inputs.size(); ++i)
      accumulated.push_back(&subjects[output.inputs[i]]);
  }
  return accumulated;
}

}  // namespace varve
