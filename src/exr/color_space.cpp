#include "exr/color_space.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"

namespace varve {
namespace {

namespace ocio = OCIO_NAMESPACE;

// OpenColorIO's own choice, but with exact powers and logarithms: the fast ones differ between processors.
constexpr auto kQuality = ocio::OptimizationFlags(ocio::OPTIMIZATION_DEFAULT & ~ocio::OPTIMIZATION_FAST_LOG_EXP_POW);

// Where displays have long been white; keeps infinities out of matrices, where they would turn into NaN.
constexpr float kDisplayLimit = 65504.f;

struct NamedConfig {
  std::string path;
  ocio::ConstConfigRcPtr config;
};

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// OpenColorIO's message as a part of a sentence: one line, without its own "Error" prefixes and full stop.
std::string reason(const std::exception& failure) {
  std::string text = failure.what();
  for (const std::string prefix : {"Error: ", "Error ", "error: ", "error "})
    for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
  std::ranges::replace(text, '\n', ' ');
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

/// The names that look like the one asked for come first; a dozen are enough to go on.
std::string shortlist(std::vector<std::string> names, const std::string& asked) {
  constexpr std::size_t kMost = 12;
  const std::string wanted = lowered(asked);
  std::stable_partition(names.begin(), names.end(), [&](const std::string& name) {
    const std::string low = lowered(name);
    return !wanted.empty() && (low.find(wanted) != std::string::npos || wanted.find(low) != std::string::npos);
  });
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) list += (i ? ", \"" : "\"") + names[i] + "\"";
  if (names.size() > kMost) list += " and " + std::to_string(names.size() - kMost) + " more";
  return list.empty() ? "none" : list;
}

NamedConfig load_config(const std::string& given) {
  std::string path = given;
  if (path.empty()) {
    const char* from_environment = std::getenv("OCIO");
    if (!from_environment || !*from_environment)
      throw Failure(ExitCode::usage,
                    "A color space was named, but there is no OpenColorIO config: give one with --ocio FILE or set the "
                    "environment variable OCIO.");
    path = from_environment;
  }
  const std::string origin = given.empty() ? " (from $OCIO)" : "";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) || std::filesystem::is_directory(path, ignored))
    throw Failure(ExitCode::input,
                  "OpenColorIO config " + path + origin + " is missing or no file: name a config.ocio.");
  try {
    return {path, ocio::Config::CreateFromFile(path.c_str())};
  } catch (const std::exception& failure) {
    throw Failure(ExitCode::input, "OpenColorIO config " + path + origin +
                                       " cannot be read; check it with ociocheck: " + reason(failure) + ".");
  }
}

/// The space itself, or the role scene_linear when none is named.
std::string known_space(const NamedConfig& from, const std::string& asked) {
  const std::string name = asked.empty() ? ocio::ROLE_SCENE_LINEAR : asked;
  if (from.config->getColorSpace(name.c_str())) return name;
  std::vector<std::string> names;
  for (int i = 0; i < from.config->getNumColorSpaces(); ++i) names.push_back(from.config->getColorSpaceNameByIndex(i));
  throw Failure(ExitCode::usage, "OpenColorIO config " + from.path + " has no color space or role \"" + name +
                                     "\"; it has: " + shortlist(std::move(names), asked) + ".");
}

std::string known_display(const NamedConfig& from, const std::string& asked) {
  std::vector<std::string> names;
  for (int i = 0; i < from.config->getNumDisplays(); ++i) names.push_back(from.config->getDisplay(i));
  const std::string name = asked.empty() ? from.config->getDefaultDisplay() : asked;
  if (std::ranges::find(names, name) != names.end()) return name;
  throw Failure(ExitCode::usage, "OpenColorIO config " + from.path + " has no display \"" + name +
                                     "\"; it has: " + shortlist(std::move(names), asked) + ".");
}

std::string known_view(const NamedConfig& from, const std::string& display, const std::string& asked) {
  std::vector<std::string> names;
  for (int i = 0; i < from.config->getNumViews(display.c_str()); ++i)
    names.push_back(from.config->getView(display.c_str(), i));
  const std::string name = asked.empty() ? from.config->getDefaultView(display.c_str()) : asked;
  if (std::ranges::find(names, name) != names.end()) return name;
  throw Failure(ExitCode::usage, "OpenColorIO config " + from.path + ", display \"" + display + "\", has no view \"" +
                                     name + "\"; it has: " + shortlist(std::move(names), asked) + ".");
}

/// Runs `make`, which asks the config for processors, and says plainly what is amiss (a LUT file that is gone, say).
template <class Make>
auto made_from(const NamedConfig& from, const std::string& what, const Make& make) {
  try {
    return make();
  } catch (const std::exception& failure) {
    throw Failure(ExitCode::input, "OpenColorIO config " + from.path + " gives no conversion " + what +
                                       "; check it with ociocheck: " + reason(failure) + ".");
  }
}

/// Only matrices without offsets, and without alpha in the colors: scaling by alpha then commutes with the conversion.
bool is_linear(const ocio::ConstProcessorRcPtr& processor) {
  const ocio::GroupTransformRcPtr group = processor->getOptimizedProcessor(kQuality)->createGroupTransform();
  for (int i = 0; i < group->getNumTransforms(); ++i) {
    const auto matrix = ocio::DynamicPtrCast<const ocio::MatrixTransform>(group->getTransform(i));
    if (!matrix) return false;
    double offset[4], m44[16];
    matrix->getOffset(offset);
    matrix->getMatrix(m44);
    for (int row = 0; row < 3; ++row)
      if (offset[row] != 0 || m44[4 * row + 3] != 0) return false;
  }
  return true;
}

bool is_finite(const glm::vec4& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

void run(const ocio::ConstCPUProcessorRcPtr& cpu, glm::vec4* pixels, int count) {
  ocio::PackedImageDesc row(pixels, count, 1, 4);
  cpu->apply(row);
}

/// What a premultiplied color is divided by; 1 where dividing makes no sense (no alpha) or no number.
float divisor(const glm::vec4& c) {
  const glm::vec4 divided = c / c.w;
  return c.w > 0 && is_finite(divided) ? c.w : 1.f;
}

/// Non-finite pixels do not enter: lookups and matrices are free to do anything with them. They come out as they were.
void convert_row(const ocio::ConstCPUProcessorRcPtr& cpu, bool linear, glm::vec4* row, int count) {
  std::vector<glm::vec4> work(row, row + count);
  for (glm::vec4& c : work) {
    const float alpha = linear || !is_finite(c) ? 1.f : divisor(c);
    c = is_finite(c) ? glm::vec4(c.x / alpha, c.y / alpha, c.z / alpha, 1.f) : glm::vec4(0.f, 0.f, 0.f, 1.f);
  }
  run(cpu, work.data(), count);
  for (int x = 0; x < count; ++x) {
    if (!is_finite(row[x])) continue;
    const float alpha = linear ? 1.f : divisor(row[x]);
    row[x] = glm::vec4(work[std::size_t(x)].x * alpha, work[std::size_t(x)].y * alpha, work[std::size_t(x)].z * alpha,
                       row[x].w);
  }
}

float displayable(float value) {
  if (!(value > -kDisplayLimit)) return std::isnan(value) ? 0.f : -kDisplayLimit;
  return std::min(value, kDisplayLimit);
}

}  // namespace

struct ColorConversion::Processor {
  ocio::ConstCPUProcessorRcPtr cpu;
  bool linear = false;
};

ColorConversion::ColorConversion(std::unique_ptr<Processor> processor) : processor_(std::move(processor)) {}
ColorConversion::ColorConversion(ColorConversion&&) noexcept = default;
ColorConversion& ColorConversion::operator=(ColorConversion&&) noexcept = default;
ColorConversion::~ColorConversion() = default;

ColorConversion ColorConversion::between(const std::string& config, const std::string& from, const std::string& to) {
  const NamedConfig named = load_config(config);
  const std::string source = known_space(named, from), target = known_space(named, to);
  const std::string what = "from \"" + source + "\" to \"" + target + "\"";
  return ColorConversion(made_from(named, what, [&] {
    const auto processor = named.config->getProcessor(source.c_str(), target.c_str());
    return std::make_unique<Processor>(Processor{processor->getOptimizedCPUProcessor(kQuality), is_linear(processor)});
  }));
}

void ColorConversion::apply(Plane<glm::vec4>& color, Workers& workers) const {
  if (color.empty()) return;
  const Window& window = color.window();
  workers.for_rows(window.y0, window.y1,
                   [&](int y) { convert_row(processor_->cpu, processor_->linear, color.row(y), window.width()); });
}

struct DisplayTransform::Processor {
  ocio::ConstCPUProcessorRcPtr cpu;
};

DisplayTransform::DisplayTransform(std::unique_ptr<Processor> processor) : processor_(std::move(processor)) {}
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;
DisplayTransform::~DisplayTransform() = default;

DisplayTransform DisplayTransform::make(const std::string& config, const std::string& from, const std::string& display,
                                        const std::string& view) {
  const NamedConfig named = load_config(config);
  const std::string source = known_space(named, from), screen = known_display(named, display);
  const std::string look = known_view(named, screen, view);
  const std::string what = "from \"" + source + "\" to display \"" + screen + "\", view \"" + look + "\"";
  return DisplayTransform(made_from(named, what, [&] {
    const auto processor =
        named.config->getProcessor(source.c_str(), screen.c_str(), look.c_str(), ocio::TRANSFORM_DIR_FORWARD);
    return std::make_unique<Processor>(Processor{processor->getOptimizedCPUProcessor(kQuality)});
  }));
}

void DisplayTransform::apply_row(glm::vec4* pixels, int count) const {
  if (count <= 0) return;
  for (int x = 0; x < count; ++x)
    for (int c = 0; c < 3; ++c) pixels[x][c] = displayable(pixels[x][c]);
  std::vector<float> alpha(static_cast<std::size_t>(count));
  for (int x = 0; x < count; ++x) alpha[std::size_t(x)] = std::exchange(pixels[x].w, 1.f);
  run(processor_->cpu, pixels, count);
  for (int x = 0; x < count; ++x) pixels[x].w = alpha[std::size_t(x)];
}

}  // namespace varve
