// What a user asks for: inputs, outputs, frames and every choice. Filled by the command line, or by a program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/parameters.h"
#include "plan/plan.h"
#include "plan/probe.h"
#include "rerender/request.h"

namespace varve {

/// Everything a resolve needs to know; the command line fills it, a program may.
struct ResolveJob {
  InputSequence input;
  SequencePattern output;
  std::optional<SequencePattern> diagnostics;  ///< separate diagnostic files
  std::vector<int> frames;                     ///< frames to write; empty: all on disk
  int preroll = 0;                             ///< frames read before the first one written, to warm the history up
  std::vector<int> cuts;                       ///< first frames of new shots
  bool find_cuts = false;                      ///< look for more of them in the pixels
  RoleRequest roles;
  bool check_motion = true;     ///< hold the vectors against the pixels of a few frames first
  std::string jitter = "auto";  ///< see parse_jitter_source
  std::string camera = "auto";  ///< see parse_camera_source
  Parameters parameters;
  OutputRequest request;
  std::optional<Compression> compression;
  int zip_level = 1;
  std::string ocio_config, from_space, to_space;  ///< color conversion around the resolve; empty: none
  std::string preview_folder;                     ///< PNG of color and diagnostics; empty: none
  std::string display, view;       ///< OpenColorIO display and view of the previews; empty: the config's default
  std::vector<std::string> extra;  ///< patterns of files with further samples; * in a name stands for anything
  std::string extra_list;          ///< list of renders that tells where they lie; empty: they tell it themselves
  RerenderRequest rerender;        ///< what is wanted of every pixel; its lists are written by the caller
  std::string report;              ///< written by the caller when all is done; here only checked; empty: none
  bool resume = false;
  double wait_seconds = 0;          ///< how long to wait for requested frames that are not there yet; 0: not at all
  std::string state_in, state_out;  ///< files of the history before the first and after the last frame; empty: none
  int threads = 0;                  ///< 0: every processor
};

}  // namespace varve
