#include "rerender_topic.h"

namespace varve::cli {

Topic rerender_topic() {
  return {
      "rerender",
      "LISTS OF RENDERS",
      "What `varve resolve --rerender` writes. JSON: an object whose member renders is a list with an object for each "
      "rectangle of a frame. CSV: a line for each sample of each rectangle. Sample k of a frame lies at the same place "
      "of the pixel in all its rectangles. Which samples are worth most: the expected variance of a pixel's luminance "
      "L after L / (1 + L) is summed over the tile, and m samples more leave 1 / (1 + m) of it, because frames around "
      "get theirs as well. Of several colors the first decides.",
      {{"format, schema", "\"varve rerender list\" and 1; members may be added under the same number."},
       {"width, height", "Of the display window, pixels."},
       {"extra", "Pattern that finds all files of the list, for --extra."},
       {"want_samples, want_noise, tile, budget", "As asked for."},
       {"frames, pixels", "That were looked at: frames written, and the pixels of all."},
       {"samples, samples_per_pixel", "That the list asks for in all, and for each of these pixels on average."},
       {"variance, gain",
        "Expected variance summed over pixels, and how much of it the samples take away; for the whole "
        "list and for each rectangle."},
       {"frame, rectangle", "Frame number, and a count from 0 within the frame."},
       {"window (x0 y0 x1 y1)",
        "Pixels from the upper left corner of the display window, y down; x1 and y1 are the "
        "first ones beyond."},
       {"border (min_x max_x min_y max_y)",
        "The same in fractions of the display window, y up, as Blender and Cycles "
        "take it. Blender cuts off fractions of a pixel: add a quarter of one, as "
        "scripts/rerender_blender.py does."},
       {"region (min_x max_x min_y max_y)",
        "The same in pixels, y down, both ends included, as the options "
        "region_min_x and so on of Arnold take it (by its documentation)."},
       {"samples", "To render, each as a picture of one sample in each pixel. In CSV its number, sample."},
       {"jitter (jx jy)",
        "For each sample: position minus pixel center in pixels, x right, y down. `varve help "
        "jitter-conventions` tells what renderers want instead. Each lies as far as can be from "
        "those of the frames up to four away."},
       {"files (file)",
        "For each sample the name that its file should have; --extra takes any, as long as * and the "
        "frame number find it."},
       {"reason",
        "rejected: history was turned down and only the pixel's own sample is left; noise: too few samples or "
        "too much noise; both."},
       {"failed_pixels, noisy_pixels", "Pixels of the rectangle with one reason or the other."},
       {"lacking", "Samples that they lack (--aov evaluation), summed."},
       {"What --extra needs",
        "A data window that tells where the crop lies, or a member window in the JSON of Cycles' "
        "Note, or --extra-list; the jitter as the attribute jitter (v2f), in the Note, or "
        "--extra-list; and the channels of the frames."}}};
}

}  // namespace varve::cli
