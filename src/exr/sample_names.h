// Names of parts and layers that hold one of several samples in each pixel: sample.0, samples.3, s0, beauty.sample_12.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace varve {

/// What the name of a layer says: which sample it holds, and of what.
struct SampleName {
  int number = 0;
  std::string stem;  ///< the path without the element (or the two) that count samples
};

/// The first element of `path` that counts samples: a word for samples with a number behind it, in the same element
/// (s0, sample_12) or the next one (sample.0). None where no element does; s alone counts only in one element.
std::optional<SampleName> parse_sample_name(std::span<const std::string> path);
/// The same of a name with dots.
std::optional<SampleName> parse_sample_name(const std::string& name);

/// A color layer of file 0.
struct NamedLayer {
  std::string view, layer;
};

/// Layers that are samples, as places in the list that was given: view by view, stem by stem, in the order of their
/// numbers.
struct ChosenSamples {
  std::vector<std::size_t> layers;
  std::string note;  ///< on what was left out; may be empty
};

/// Chooses the samples of the stems in `asked` (RoleRequest::layers), else those of the main color of each view: no
/// stem, or beauty and the like, or the first there is. Throws Failure(inconsistent), naming `path` and the remedy,
/// when there are none, and when numbers are missing, start beyond 1 or come twice.
ChosenSamples choose_samples(std::span<const NamedLayer> layers, std::span<const std::string> asked,
                             const std::string& path);

}  // namespace varve
