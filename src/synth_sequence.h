// Scenes with known truth, written as sequences: jittered samples with exact depth, motion and ids, the filtered truth,
// and renders with more samples as yardsticks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/raw_plane.h"
#include "synth/positions.h"

namespace varve {

/// Where the camera is written: standard attributes, JSON in the attribute Note as Cycles' users have it, both,
/// nowhere.
enum class SynthCameras { attributes, note, both, none };

struct SynthJob {
  std::string scene;                    ///< name of the scene table
  std::string folder;                   ///< made when it is not there
  std::vector<int> frames;              ///< empty: all frames of the scene
  int width = 0, height = 0;            ///< 0: as the scene says
  int samples = 1;                      ///< more than one: a part for each, sample.0, sample.1, ...
  bool layers = false;                  ///< fg, mid and bg beside the composite
  std::string jitter = "halton23:16";   ///< none, a CSV file or a sequence; its length counts frames
  double noise = 0;                     ///< deviation of a factor with mean 1 on every sample
  int seed = 1;                         ///< of noise, chance, and the places of truth
  PixelType type = PixelType::float16;  ///< of color and alpha
  SynthCameras cameras = SynthCameras::attributes;
  std::optional<synth::Filter> truth;
  int truth_samples = 256;      ///< rounded up to a square
  std::vector<int> yardsticks;  ///< n of n x n stratified samples, box filter
  int threads = 0;
};

struct SynthEvents {
  std::function<void(int frame, int done, int total)> frame;
  std::function<bool()> should_stop;  ///< looked at between files
};

/// Writes FOLDER/SCENE.####.exr, FOLDER/jitter.csv, and what else is asked for: FOLDER/truth/SCENE.####.exr,
/// FOLDER/ssN/SCENE.####.exr. Returns how many frames were written. Throws Failure.
int synth_sequence(const SynthJob& job, const SynthEvents& events);

}  // namespace varve
