// The channels of a frame by layer path and view, as their names tell. Shared by the files that look for roles.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exr/channel_names.h"
#include "exr/file_header.h"

namespace varve {

std::string lower_case(std::string_view text);
std::vector<std::string> split_at_dots(std::string_view name);

/// What a layer of that name (one element, any case) holds: Vector -> motion, Combined -> color; none if it says
/// nothing.
std::optional<ChannelClass> class_of_layer(std::string_view element);

/// Channels that share file, part, view and layer path. `path` has the elements of the part name first (in files of
/// several parts, unless the channels repeat them), then those of the layer, the view taken out.
struct ChannelGroup {
  int file = 0, part = 0;
  std::string view;  ///< "" when neither the part nor the file has views
  std::vector<std::string> path;
  std::size_t part_elements = 0;  ///< how many of `path` come from the part name alone
  struct Member {
    std::string base;  ///< last element of the channel name, lower case
    ChannelRef ref;
    PixelType type = PixelType::float16;
  };
  std::vector<Member> members;
  std::vector<Member> subsampled;  ///< channels without a value at every pixel: passed through, never resolved

  /// The float channel of that base name (lower case); none if there is none.
  std::optional<ChannelRef> find(std::string_view base) const;
  /// What the layer holds by the last element of its path.
  std::optional<ChannelClass> holds() const;
};

struct ChannelIndex {
  std::span<const FileHeader> files;
  std::vector<ChannelGroup> groups;  ///< in file order; deep parts are left out
  std::vector<std::string> views;    ///< of file 0, default first; empty if it has none

  /// A channel of view b may serve a color of view a. What has no view serves only where there is one view at most.
  bool views_match(const std::string& a, const std::string& b) const;
  /// Name as the user sees it: the channel's, with `part:` before it in files of several parts.
  std::string name(ChannelRef ref) const;
  const Channel& channel(ChannelRef ref) const;
};

ChannelIndex index_channels(std::span<const FileHeader> files);

/// Layer path as text.
std::string join_path(std::span<const std::string> path);

/// A place a role may be taken from: the layer it belongs to, and its channels (only x for depth and id).
struct RoleCandidate {
  const ChannelGroup* group = nullptr;
  std::size_t owner = 0;  ///< the first `owner` elements of the group's path name the layer it belongs to
  int quality = 0;        ///< lower is better among equals
  ChannelRef x, y, z{};
};

/// The best candidate for a color layer: same view, owner above or equal to the layer; longest owner, then same part,
/// then earlier. Role files come after file 0; there a single candidate serves any layer. `main_color`: a lone
/// candidate of file 0 may serve although it belongs to another layer.
struct RoleChoice {
  RoleCandidate candidate;
  bool foreign = false;  ///< belongs to another layer, taken because it is the only one
};
std::optional<RoleChoice> choose_role(const ChannelIndex& index, const ChannelGroup& color, bool main_color,
                                      std::span<const RoleCandidate> candidates);

/// Finds the vectors of a subject and fills convention, encodings and notes (find_motion.cpp). `color` is the subject's
/// group. Throws Failure(inconsistent) when vectors are there whose convention nothing tells.
void find_motion(const ChannelIndex& index, const ChannelGroup& color, bool main_color, const RoleRequest& request,
                 Subject& subject);

/// Finds the id, the normal and the masks of a subject (find_marks.cpp). What is not there is no failure: the plan
/// refuses what needs it.
void find_marks(const ChannelIndex& index, const ChannelGroup& color, bool main_color, const RoleRequest& request,
                Subject& subject);

/// Finds what a layer lets through (find_transmittance.cpp), where layers are to be combined. Throws
/// Failure(inconsistent) when channels are asked for and the layer has none.
void find_transmittance(const ChannelIndex& index, const ChannelGroup& color, const LayersRequest& request,
                        Subject& subject);

/// Finds the layers and channels of request.channels in file 0 (find_channels.cpp) and makes each a companion of the
/// subject it belongs to or a subject of its own. Only what may be averaged: throws Failure(inconsistent) with the
/// reason when a name is not there, or leads to vectors, depths, ids and the like, or to a color that is resolved
/// already; what a pattern meets of these is left out and noted.
void add_channels(const ChannelIndex& index, const RoleRequest& request, std::vector<Subject>& subjects);

/// The main color of a view by its name (bare R G B A, beauty and the like), where it is none of `subjects`.
struct MainColor {
  std::string layer;
  ColorPlace place;
};
std::optional<MainColor> main_color_beside(const ChannelIndex& index, const std::string& view,
                                           std::span<const Subject> subjects);

/// The channel that `--map role=` names; in the subject's part if it is there, else the first of that name. None if the
/// role is not mapped. Throws Failure(inconsistent) if there is no such channel, or if it holds integers and `integers`
/// does not allow them.
std::optional<ChannelRef> mapped_channel(const ChannelIndex& index, const RoleRequest& request, std::string_view role,
                                         int preferred_part, bool integers = false);

}  // namespace varve
