// Every pass of the library in one table, so that the laws of stability are asked of all of them alike.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gather/gather.h"
#include "resolve/accumulate.h"
#include "stability/shots.h"

namespace varve::stability {

/// What a pass gives: colors that scale with the light, and numbers that do not.
struct Planes {
  std::vector<Plane<glm::vec4>> colors;
  std::vector<Plane<float>> numbers;
};

/// How the recursive and the two-sided accumulator are set up.
struct Settings {
  RecursiveParameters recursive;
  RectifyParameters rectify;
};

/// A pass over the frames of a shot, by itself or as often as an accumulator runs it.
struct Pass {
  std::string name;
  std::function<Planes(const RawShot&, Workers&)> run;
  /// Pixels around a changed one, at rest, beyond which nothing may change; more than a picture: none.
  int support = 4;
  bool scales = true;       ///< light times 2^k gives the result times 2^k, bit for bit
  bool constant = true;     ///< one color everywhere comes out as it is
  double mirror = 1e-4;     ///< relative difference that a mirror may make by its other order of sums; < 0: has a grid
  double mirror_share = 0;  ///< share of the pixels that may differ by more: ties that a mirror decides otherwise
  // What it is made of, for those that have a slow twin.
  std::optional<Settings> recursive = {}, two_sided = {};
};

/// Sanitizing, sample weights, every box with every rule, anchor and space that goes with it, windows and moments,
/// history filters, weights and tests, companions, prediction, sharpening, fallbacks, two-sided.
std::vector<Pass> resolve_passes();
/// The gather, layers, samples, deep pixels.
std::vector<Pass> combining_passes();
/// Dilation, turned-round vectors, cameras, repair.
std::vector<Pass> motion_passes();

std::vector<Pass> all_passes();

/// One that stands for each family.
std::vector<Pass> few_passes();

}  // namespace varve::stability
