#include <cmath>
#include <random>

#include "deep/flatten.h"
#include "layers/composite.h"
#include "layers/transmittance.h"
#include "plan/knob_words.h"
#include "reference/deep_reference.h"
#include "reference/gather_reference.h"
#include "reference/history_filter_reference.h"
#include "reference/layers_reference.h"
#include "reference/samples_reference.h"
#include "resolve/sharpen.h"
#include "samples/resolve_samples.h"
#include "stability/twins_parts.h"
#include "support/gather_scenes.h"

namespace varve::stability {

void measure_combining(const std::vector<Input>& inputs, std::vector<Measured>& rows, Workers& workers) {
  Measured& layered = row_of(rows, "composite_presents", words_of(inputs) + " as 3 layers", 1e-6);
  Measured& sampled = row_of(rows, "resolve_samples", words_of(inputs) + " as 3 samples, 5 filters", 1e-6);
  Measured& sharp = row_of(rows, "sharpen", words_of(inputs), 1e-6);
  for (const Input& input : inputs) {
    std::vector<Present> presents;
    for (const RawFrame& raw : input.shot) presents.push_back(present_of(raw, workers));
    std::vector<const Present*> list;
    for (const Present& p : presents) list.push_back(&p);
    for (const Word<SampleFilter>& filter : kSampleFilters) {
      ++sampled.runs;
      const Present fast = resolve_samples(list, filter.value, workers);
      each_pixel(kTwinWindow, [&](int x, int y) {
        const glm::dvec4 slow = reference::resolved_pixel(presents, filter.value, x, y).color;
        double size = 0;
        for (const Present& p : presents) size = std::max(size, size_around(p, nullptr, x, y, 3));
        for (int k = 0; k < 4; ++k, ++sampled.values)
          sampled.take(double(fast.color.at(x, y)[k]) - std::clamp(slow[k], -3.4028235e38, 3.4028235e38), 4 * size,
                       std::string(filter.word) + ", " + input.name);
      });
    }
    for (const double strength : {0.3, 1.0}) {
      ++sharp.runs;
      const History h = accumulate(presents[0], {}, {}, {}, {}, 1, {}, workers).history;
      const Plane<glm::vec4> fast = sharpen(h.color, h.total, strength, workers);
      each_pixel(kTwinWindow, [&](int x, int y) {
        const glm::dvec4 slow = reference::sharpened(h.color, h.total, strength, x, y);
        for (int k = 0; k < 4; ++k, ++sharp.values)
          sharp.take(double(fast.at(x, y)[k]) - slow[k], size_around(presents[0], nullptr, x, y, 1), input.name);
      });
    }
    for (Present& p : presents) hold_opacity(p, workers);
    for (const LayerRule rule : {LayerRule::variation, LayerRule::contribution}) {
      ++layered.runs;
      const Present fast = composite_presents(list, kTwinWindow, rule, true, workers);
      each_pixel(kTwinWindow, [&](int x, int y) {
        const reference::StackedPixel slow = reference::stacked_pixel(list, rule, x, y);
        double size = 0;
        for (const Present& p : presents) size = std::max(size, size_around(p, nullptr, x, y, 0));
        for (int k = 0; k < 4; ++k, ++layered.values)
          layered.take(double(fast.color.at(x, y)[k]) - std::clamp(slow.color[k], -3.4028235e38, 3.4028235e38), size,
                       input.name);
      });
    }
  }
}

void measure_gather(bool thorough, std::vector<Measured>& rows, Workers& workers) {
  Measured& row = row_of(rows, "gather", "two planes that slide, 5 frames of 21x19", 2e-6);
  std::vector<int> cell_counts = {4};
  if (thorough) cell_counts = {1, 2, 4, 6, 8};
  for (const int cells : cell_counts)
    for (const Word<SampleFilter>& filter : kSampleFilters) {
      if (filter.value == SampleFilter::mitchell) continue;
      if (!thorough && filter.value != SampleFilter::none) continue;
      for (const bool marks : {true, false}) {
        ++row.runs;
        test::ShotOptions options;
        options.frames = 5, options.window = {0, 0, 21, 19}, options.ids = options.depths = marks;
        const test::Shot shot = test::take(test::TwoPlanes{}, options, workers);
        const std::vector<GatherSource> sources = shot.sources();
        GatherParameters p;
        p.gain = false, p.change_limit = 0, p.cells = cells, p.filter = filter.value;
        const auto carried = reference::carry_samples(sources, 2, shot.test());
        const Accumulated fast = gather(sources, 2, p, shot.test(), {}, workers);
        each_pixel(options.window, [&](int x, int y) {
          const glm::dvec4 slow = reference::gathered_pixel(sources, 2, carried, p, shot.test(), x, y);
          for (int k = 0; k < 4; ++k, ++row.values)
            row.take(double(fast.history.color.at(x, y)[k]) - slow[k], 1.5,
                     std::to_string(cells) + " cells, " + std::string(filter.word));
        });
      }
    }
}

void measure_deep(bool thorough, std::vector<Measured>& rows) {
  Measured& row = row_of(rows, "flatten deep", "points and volumes that meet, coincide, hide and emit", 1e-12);
  std::mt19937 random(3);
  FlattenScratch scratch;
  for (int i = 0; i < (thorough ? 20000 : 400); ++i) {
    ++row.runs;
    std::vector<reference::Piece> pieces;
    std::vector<DeepSample> samples;
    for (std::size_t n = 1 + random() % 12; n-- > 0;) {
      reference::Piece piece;
      piece.front = 1 + int(random() % 12);
      piece.back = piece.front + (random() % 3 ? int(random() % 7) : 0);
      const unsigned kind = random() % 8;
      piece.alpha = kind == 0 ? 0 : kind == 1 ? 1 : kind == 2 ? 1e-30 : std::ldexp(double(random() % 1000), -10);
      piece.color = std::ldexp(double(random() % 4096), int(random() % 40) - 20);
      DeepSample s;
      s.front = piece.front, s.back = piece.back;
      s.opacity = glm::dvec4(piece.alpha), s.color = glm::dvec4(piece.color, 0, 0, 0);
      s.index = std::uint32_t(samples.size());
      samples.push_back(s), pieces.push_back(piece);
    }
    const reference::Flat slow = reference::flatten(reference::tidy(pieces));
    const FlatPixel fast = flatten(samples, false, LayerRule::variation, scratch);
    row.values += 2;
    row.take(fast.color.r - slow.color, 1e-6 + std::abs(slow.color), "color");
    row.take(fast.color.a - slow.alpha, 1, "alpha");
  }
}

}  // namespace varve::stability
