// OpenColorIO around the resolve: into the working space, out of it, and to a display for previews.
#pragma once

#include <memory>
#include <string>

#include <glm/vec4.hpp>

#include "base/parallel.h"
#include "base/plane.h"

namespace varve {

/// A conversion between two spaces of an OpenColorIO config. Alpha passes through; premultiplied colors are divided by
/// alpha before and multiplied after where alpha > 0, unless the conversion is linear.
class ColorConversion {
 public:
  /// `config`: path of a config, or empty for $OCIO. `to` empty: the role scene_linear. Throws Failure(usage) naming
  /// the config and the spaces it has when something is unknown, and when no config is told; Failure(input) when the
  /// config or a file it needs is missing or broken.
  static ColorConversion between(const std::string& config, const std::string& from, const std::string& to);

  ColorConversion(ColorConversion&&) noexcept;
  ColorConversion& operator=(ColorConversion&&) noexcept;
  ~ColorConversion();

  /// Converts every pixel of the window in place, rows in parallel. Pixels with a non-finite
  /// color stay as they are, and touch no other; non-finite results are left for the caller to sanitize.
  void apply(Plane<glm::vec4>& color, Workers& workers) const;

 private:
  struct Processor;
  explicit ColorConversion(std::unique_ptr<Processor>);
  std::unique_ptr<Processor> processor_;
};

/// Scene-linear to a display and view of a config, for previews.
class DisplayTransform {
 public:
  /// Empty display or view: the config's default. Throws Failure(usage) like ColorConversion::between.
  static DisplayTransform make(const std::string& config, const std::string& from, const std::string& display,
                               const std::string& view);
  DisplayTransform(DisplayTransform&&) noexcept;
  DisplayTransform& operator=(DisplayTransform&&) noexcept;
  ~DisplayTransform();
  /// In place; alpha passes through, and colors are taken as over black. NaN counts as 0, infinities as +-65504.
  void apply_row(glm::vec4* pixels, int count) const;

 private:
  struct Processor;
  explicit DisplayTransform(std::unique_ptr<Processor>);
  std::unique_ptr<Processor> processor_;
};

}  // namespace varve
