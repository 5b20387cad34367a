// What the command line fills.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare_sequence.h"
#include "exr/jitter_list.h"
#include "measure_sequence.h"
#include "resolve_sequence.h"
#include "synth_sequence.h"

namespace varve::cli {

enum class ProgressStyle { automatic, bar, plain, openjd, json, none };

struct Settings {
  ResolveJob job;  ///< resolve; probe describes the same job

  std::optional<SequencePattern> depth_files, motion_files;
  bool dry_run = false;
  ProgressStyle progress = ProgressStyle::automatic;
  bool quiet = false, verbose = false;

  int pixels = 0;         ///< frames whose pixels probe measures
  int jitter_frames = 0;  ///< frames whose jitter probe measures
  bool facts = false;     ///< probe looks for cuts, flashes and the like
  bool json = false;
  int vectors = 0;      ///< pairs of frames whose vectors probe tests object by object
  bool motion = false;  ///< whether probe holds the vectors against the pixels

  CompareJob compare;          ///< shares frames, cuts, roles and threads with `job`
  RoleRequest only_a, only_b;  ///< layers and mapped channels of one side
  std::string json_file, csv_file, html_file;
  SynthJob synth;

  MeasureJob measure;  ///< shares input, frames, cuts, roles and threads with `job`
  std::vector<std::string> presets, sweeps, singles;
  std::string plot_file;
  /// Every option as it was given, "--name=value": what measure hands on to the runs of resolve.
  std::vector<std::pair<unsigned, std::string>> given;  ///< with the commands that know it

  JitterListJob jitter;
  std::string jitter_file;  ///< empty: standard output
  bool jitter_json = false;

  std::string topic;  ///< what help is asked about; empty: the program
  bool all = false, man = false;
  std::string completion;  ///< shell; empty: none
};

}  // namespace varve::cli
