#include "exr/sample_names.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <string_view>

#include "base/error.h"
#include "exr/channel_index.h"

namespace varve {
namespace {

constexpr std::string_view kWords[] = {"s", "sample", "samples", "subsample", "subpixel", "smp", "spp"};

bool is_word(std::string_view text) {
  return std::find(std::begin(kWords), std::end(kWords), text) != std::end(kWords);
}

/// A plain number of at most six digits.
std::optional<int> count_of(std::string_view text) {
  int number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool digits = !text.empty() && text[0] >= '0' && text[0] <= '9' && text.size() <= 6;
  if (!digits || problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Word and number in one element.
std::optional<int> number_in(std::string_view element) {
  const std::size_t digits = element.find_first_of("0123456789");
  if (digits == std::string_view::npos) return std::nullopt;
  std::string_view word = element.substr(0, digits);
  if (!word.empty() && (word.back() == '_' || word.back() == '-')) word.remove_suffix(1);
  return is_word(word) ? count_of(element.substr(digits)) : std::nullopt;
}

/// Samples of one thing in one view, by number.
struct Family {
  std::string view, stem;
  std::map<int, std::size_t> layers;
};

std::string named(const std::string& stem) { return stem.empty() ? "the main color" : "layer " + stem; }

std::vector<Family> families_of(std::span<const NamedLayer> layers, const std::string& path) {
  std::vector<Family> families;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::optional<SampleName> name = parse_sample_name(layers[i].layer);
    if (!name) continue;
    const auto same = [&](const Family& f) { return f.view == layers[i].view && f.stem == name->stem; };
    auto family = std::find_if(families.begin(), families.end(), same);
    if (family == families.end()) family = families.insert(families.end(), {layers[i].view, name->stem, {}});
    if (!family->layers.emplace(name->number, i).second)
      throw Failure(ExitCode::inconsistent, path + ": sample " + std::to_string(name->number) + " of " +
                                                named(name->stem) + " is there twice, once as " + layers[i].layer +
                                                "; rename one of them, or leave --samples out");
  }
  return families;
}

void check_numbers(const Family& family, const std::string& path) {
  int expected = family.layers.begin()->first;
  if (expected > 1) expected = 0;
  for (const auto& [number, layer] : family.layers) {
    if (number != expected)
      throw Failure(ExitCode::inconsistent, path + ": sample " + std::to_string(expected) + " of " +
                                                named(family.stem) + " is missing, though there is sample " +
                                                std::to_string(number) +
                                                "; render it again, or leave the frame out with --frames");
    ++expected;
  }
}

int rank_of(const std::string& stem) {
  const std::string name = lower_case(stem);
  if (name.empty()) return 0;
  return name == "beauty" || name == "rgba" || name == "rgb" || name == "main" ? 1 : 2;
}

[[noreturn]] void refuse_without_samples(std::span<const NamedLayer> layers, const std::string& path) {
  std::string names;
  for (std::size_t i = 0; i < layers.size() && i < 8; ++i)
    names += (names.empty() ? "" : ", ") + (layers[i].layer.empty() ? "bare RGBA" : layers[i].layer);
  throw Failure(
      ExitCode::inconsistent,
      path + ": --samples finds no numbered parts or layers such as sample.0 and sample.1, or s0 and s1, among " +
          names + "; rename them, give grid:N for a picture of N x N times the pixels, or leave --samples out");
}

}  // namespace

ChosenSamples choose_samples(std::span<const NamedLayer> layers, std::span<const std::string> asked,
                             const std::string& path) {
  const std::vector<Family> families = families_of(layers, path);
  if (families.empty()) refuse_without_samples(layers, path);
  const auto wanted = [&](const Family& f) {
    if (asked.empty())
      return std::none_of(families.begin(), families.end(), [&](const Family& other) {
        return other.view == f.view &&
               (rank_of(other.stem) < rank_of(f.stem) || (rank_of(other.stem) == rank_of(f.stem) && &other < &f));
      });
    return std::any_of(asked.begin(), asked.end(), [&](const std::string& name) {
      return lower_case(name) == "all" || lower_case(name) == lower_case(f.stem);
    });
  };
  ChosenSamples chosen;
  std::string others;
  for (const Family& family : families) {
    if (!wanted(family)) {
      others += (others.empty() ? "" : ", ") + named(family.stem);
      continue;
    }
    check_numbers(family, path);
    for (const auto& [number, layer] : family.layers) chosen.layers.push_back(layer);
  }
  if (chosen.layers.empty())
    throw Failure(ExitCode::inconsistent, path + ": --samples finds no samples of " + asked.front() +
                                              " with --layer; there are samples of " + others);
  if (!others.empty()) chosen.note = "samples: there are also those of " + others + "; choose with --layer NAME";
  return chosen;
}

std::optional<SampleName> parse_sample_name(std::span<const std::string> path) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string element = lower_case(path[i]);
    std::optional<int> number = number_in(element);
    std::size_t elements = 1;
    if (!number && element.size() > 1 && is_word(element) && i + 1 < path.size()) {
      number = count_of(path[i + 1]);
      elements = 2;
    }
    if (!number) continue;
    std::vector<std::string> rest(path.begin(), path.begin() + std::ptrdiff_t(i));
    rest.insert(rest.end(), path.begin() + std::ptrdiff_t(i + elements), path.end());
    return SampleName{*number, join_path(rest)};
  }
  return std::nullopt;
}

std::optional<SampleName> parse_sample_name(const std::string& name) { return parse_sample_name(split_at_dots(name)); }

}  // namespace varve
