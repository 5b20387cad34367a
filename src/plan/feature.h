// What the sources of temporal supersampling describe, and what of it is here: the table behind `varve help features`.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace varve {

/// How a technique is reached.
enum class Reach {
  option,    ///< by the options, presets and commands that `how` names
  built_in,  ///< it is always so; `how` says what
  renderer,  ///< not the business of a resolver; `how` says why, or what to ask the renderer for
  planned    ///< not here; `how` says what is missing
};

enum class FeatureGroup { system, technique, beyond };

struct Feature {
  FeatureGroup group;
  int number;                ///< counts from 1 within its group
  std::string_view sources;  ///< S Salvi 2016, L Lopez, Y Yang 2009, W Wronski 2014, P Pedersen 2016; "" beyond them
  std::string_view what;
  Reach reach;
  std::string_view how;  ///< options as --name or --name=word, commands as `varve NAME`: a test looks each of them up
};

/// Systems, techniques, then what goes beyond the sources; each group in the order of its numbers.
std::span<const Feature> features();

/// "system 3", "12", "beyond 4".
std::string feature_name(const Feature& feature);
std::string_view reach_name(Reach reach);

}  // namespace varve
