// Which channel plays which part: color, depth and motion found by name, per layer and view.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/combine_request.h"
#include "exr/file_header.h"
#include "motion/convention.h"

namespace varve {

using VectorChannels = std::array<ChannelRef, 2>;  ///< x, y
using NormalChannels = std::array<ChannelRef, 3>;  ///< x, y, z

/// Up to four channels that are resolved together with a subject's color, by its motion and its weights.
struct Companion {
  std::string layer;  ///< layer path, "" for bare names
  bool color = true;  ///< the places are R G B A, and each goes with that channel of the subject's color;
                      ///< false: up to four values that have nothing to do with each other
  std::array<std::optional<ChannelRef>, 4> channels;
};

/// Where a resolved color is written.
struct ColorPlace {
  int part = 0;                                    ///< of file 0; lends its name, view, windows and attributes
  std::array<std::optional<Channel>, 4> channels;  ///< R G B A as they are stored
};

/// Channels that say what a layer lets through, where that is not one minus its alpha.
struct TransmittanceChannels {
  std::array<ChannelRef, 3> channels;  ///< R G B; a scalar stands in all three places
  bool opacity = false;                ///< they hold what is held back (AR AG AB) instead of what is let through
  bool cumulative = false;             ///< of the layer and all in front of it
};

/// One thing to be resolved: a color with its own depth and motion, in one view.
struct Subject {
  std::string
      layer;  ///< layer path without the color suffix ("" for bare RGBA, "ViewLayer", "fg", part name if that tells)
  std::string view;  ///< "" when the file has no views
  bool default_view = true;
  std::array<std::optional<ChannelRef>, 4>
      color;         ///< R G B A; a lone channel stands in the place of its name, Y in that of G
  ColorPlace place;  ///< where the color was, unless several subjects make one color
  std::vector<Companion> companions;
  std::optional<ChannelRef> depth;
  std::optional<ChannelRef> id;  ///< object index, or the first rank of a Cryptomatte
  std::optional<NormalChannels> normal;
  std::optional<ChannelRef> reactive, responsive;  ///< masks, only as mapped
  std::optional<TransmittanceChannels> transmittance;
  std::optional<VectorChannels> backward, forward;  ///< as stored, before decoding
  MotionEncoding backward_encoding, forward_encoding;
  std::string convention;  ///< row of the convention table; "" when no vectors were found
  double background_depth = 1e10;
  std::vector<std::string> notes;  ///< what was assumed and from what evidence, a sentence each
};

/// How several subjects make one color.
enum class Combine { alone, layers, samples };

/// One color that is written, and the subjects that it is made from.
struct ColorOutput {
  Subject subject;                  ///< its name, its place, its companions and what is said of it
  std::vector<std::size_t> inputs;  ///< places among the subjects of the frame; layers front to back
  Combine combine = Combine::alone;
  bool after = false;          ///< each input is accumulated by itself, and what comes of them combined
  bool write_inputs = false;   ///< then: what comes of each is written as well, at its own place
  bool only_compared = false;  ///< not written: the output before it tells how much this one differs
};

/// The part that holds the subject's color.
inline int part_of(const Subject& subject) {
  for (const auto& channel : subject.color)
    if (channel) return channel->part;
  return 0;
}

/// The parts that hold the subject's color or a companion of it, ascending.
std::vector<int> parts_of(const Subject& subject);

/// What is done with several samples in a pixel.
enum class SampleMode {
  off,      ///< nothing is taken for a sample of a pixel
  resolve,  ///< they are resolved to one first, which meets the history
  each      ///< each meets a history of its own, then they are resolved to one
};

/// Which samples there are, and what is done with them.
struct SampleRequest {
  SampleMode mode = SampleMode::off;
  int grid = 0;  ///< n: every n x n pixels of the files are one; 0: parts or layers that are numbered
};

/// By which weights the channels of RoleRequest::channels are resolved.
enum class ChannelWeights {
  own,    ///< each is a subject of its own, with motion and depth of the color
  beauty  ///< they are companions of the color
};

/// What the user said about roles.
struct RoleRequest {
  SampleRequest samples;
  std::vector<std::string> layers;  ///< layers to resolve; empty: the main one of each view; {"all"}: every color layer
  std::vector<std::string> channels;  ///< further layers and channels to resolve, by name or by pattern (* and ?)
  ChannelWeights channel_weights = ChannelWeights::beauty;
  LayersRequest combine_layers;  ///< what becomes of `layers`
  std::vector<std::pair<std::string, std::string>>
      map;                          ///< role=channel: R G B A depth motion.x motion.y forward.x forward.y id normal.x
                                    ///< normal.y normal.z reactive responsive; full channel names, or part:channel as
                                    ///< probe prints them
  std::string convention = "auto";  ///< row of the table; auto: told by names, never guessed; none: no vectors are used
  MotionEncoding encoding;          ///< overrides, used where `overrides` says so
  bool override_bias = false, override_scale = false, override_shutter = false, override_sign_x = false,
       override_sign_y = false, override_unit = false, override_direction = false;
};

/// Finds the subjects in the files of one frame (file 0 has the color; depth and motion are looked for in file 0
/// and then in the role files). Views are matched with views, parts may differ. Throws Failure(inconsistent)
/// when no color is found, when a named layer or channel does not exist (naming what does), and when vectors are there
/// but their convention is not told by their names and not given. Further channels are found as add_channels says.
std::vector<Subject> find_subjects(std::span<const FileHeader> files, const RoleRequest& request);

/// What of file 0 is passed on otherwise than as it is, because it was used up: samples, of which one lends its data.
struct PassedOn {
  std::vector<ChannelRef> dropped;
  std::vector<std::pair<ChannelRef, std::string>> renamed;
};

/// What is written, and of which subjects it is made (exr/color_outputs.cpp). Every subject for itself, unless layers
/// are to be combined; a layer that is alone in its view is never combined.
std::vector<ColorOutput> color_outputs(std::span<const FileHeader> files, std::span<const Subject> subjects,
                                       const RoleRequest& request);

/// What a frame accumulates, in order: for each output itself, or each of its inputs where they are combined after.
std::vector<const Subject*> accumulated_subjects(std::span<const ColorOutput> outputs,
                                                 std::span<const Subject> subjects);

/// What a channel holds, as far as its name says; for pass-through rules and for probe.
enum class ChannelClass { color, alpha, depth, motion, normal, position, uv, id, cryptomatte, other };
ChannelClass classify(const Channel& channel);
const char* name_of(ChannelClass);

}  // namespace varve
