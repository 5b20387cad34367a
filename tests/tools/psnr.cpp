// varve_psnr REF.####.exr TEST.####.exr FRAMES [REF_LAYER [TEST_LAYER]]
// Distance of a sequence from its reference: peak 1, squared difference over R, G, B of all frames together,
// negative values count as 0. Two figures: tone-mapped x / (1 + x), and linear clipped to [0, 1].
// Layers are channel prefixes without the last dot ("" for bare R, G, B); "auto" finds the only one there is.

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "psnr.h"

namespace {

using namespace varve::tools;

std::string with_frame(const std::string& pattern, int frame) {
  const std::size_t first = pattern.find('#');
  if (first == std::string::npos) return pattern;
  const std::size_t end = std::min(pattern.find_first_not_of('#', first), pattern.size());
  std::string number = std::to_string(frame);
  const std::size_t digits = end - first == 1 ? 4 : end - first;
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return pattern.substr(0, first) + number + pattern.substr(end);
}

std::vector<int> frames_of(const std::string& text) {
  const std::size_t dash = text.find('-', 1);
  const int first = std::stoi(text), last = dash == std::string::npos ? first : std::stoi(text.substr(dash + 1));
  std::vector<int> frames;
  for (int f = first; f <= last; ++f) frames.push_back(f);
  return frames;
}

void print(const std::string& label, const Sums& s) {
  std::printf("%-12s tone %6.2f dB  linear %6.2f dB  not finite %zu\n", label.c_str(), decibels(s.tone, s.values),
              decibels(s.linear, s.values), s.not_finite);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.size() < 3 || words.size() > 5)
      throw std::runtime_error("usage: varve_psnr REF.####.exr TEST.####.exr FIRST-LAST [REF_LAYER [TEST_LAYER]]");
    const std::string ref_layer = words.size() > 3 ? words[3] : "auto",
                      test_layer = words.size() > 4 ? words[4] : "auto";
    Sums total;
    for (int frame : frames_of(words[2])) {
      const Rgb reference = read_rgb(with_frame(words[0], frame), ref_layer);
      const Rgb test = read_rgb(with_frame(words[1], frame), test_layer);
      if (reference.window != test.window)
        throw std::runtime_error("data windows differ in frame " + std::to_string(frame));
      Sums one;
      add_squares(reference, test, one);
      print("frame " + std::to_string(frame), one);
      total.tone += one.tone;
      total.linear += one.linear;
      total.values += one.values;
      total.not_finite += one.not_finite;
    }
    print("all", total);
    return total.not_finite ? 1 : 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "varve_psnr: %s\n", e.what());
    return 2;
  }
}
