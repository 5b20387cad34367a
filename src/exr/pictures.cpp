#include "exr/pictures.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "exr/pictures_module.h"
#include "exr/temporary_file.h"

namespace varve {
namespace {

constexpr const char* kModule = "varve_pictures.so";

struct Close {
  void operator()(void* module) const { dlclose(module); }
};
using Module = std::unique_ptr<void, Close>;

/// $VARVE_MODULE_PATH first, then beside the program: as installed, and as built.
std::vector<std::filesystem::path> module_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* given = std::getenv("VARVE_MODULE_PATH")) {
    std::istringstream list(given);
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) folders.emplace_back(folder);
  }
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (!failed)
    for (const char* relative : {VARVE_MODULE_FOLDER, "../lib/varve"})
      folders.push_back((program.parent_path() / relative).lexically_normal());
  return folders;
}

/// The module stays in memory once loaded (OpenImageIO does not survive leaving), so loading it again costs nothing.
Module load_module() {
  std::string tried, why;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / kModule;
    if (tried.find(folder.string()) == std::string::npos) tried += (tried.empty() ? "" : ", ") + folder.string();
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) continue;
    if (Module module{dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)}) return module;
    if (const char* text = dlerror()) why = std::string(" The loader says: ") + text + ".";
  }
  throw Failure(ExitCode::output,
                std::string("Pictures need the module ") + kModule + ", which cannot be loaded from " + tried +
                    ": install it, name its folder in VARVE_MODULE_PATH, or leave out --preview." + why);
}

template <class Function>
Function* function_of(const Module& module, const char* name) {
  void* symbol = dlsym(module.get(), name);
  if (!symbol)
    throw Failure(ExitCode::output, std::string("The picture module ") + kModule +
                                        " belongs to another version of varve: install the one that came with it.");
  return reinterpret_cast<Function*>(symbol);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Failure(ExitCode::output, "Picture " + path + " cannot be written: " + why +
                                      "; check that its folder exists, can be written to and has room.");
}

/// Writes under a temporary name beside `path`, renamed when complete.
void write_png(const Module& module, const std::string& path, const std::vector<unsigned char>& rgb,
               const Window& window) {
  const auto write = function_of<varve_write_png_v1>(module, "varve_write_png_v1_run");
  TemporaryFile temporary(path);
  std::array<char, 512> reason{};
  if (write(temporary.name().c_str(), rgb.data(), window.width(), window.height(), reason.data(), reason.size()) != 0)
    refuse(path, reason.data());
  temporary.commit();
}

/// 0 at `low`, 1 at `high`; NaN is 0, and so is everything else that compares with nothing.
float position(double value, double low, double high) {
  const double t = high == low ? double(value > high) : (value - low) / (high - low);
  return t > 0 ? float(std::min(t, 1.0)) : 0.f;
}

/// IEC 61966-2-1, linear to encoded.
float srgb(float linear) {
  if (!(linear > 0)) return 0.f;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(std::min(linear, 1.f), 1 / 2.4f) - 0.055f;
}

unsigned char to_byte(float encoded) {
  if (!(encoded > 0)) return 0;
  return static_cast<unsigned char>(std::lround(std::min(encoded, 1.f) * 255.f));
}

void require_pixels(const std::string& path, bool empty) {
  if (empty) throw Failure(ExitCode::output, "Picture " + path + " cannot be written: its data window is empty.");
}

}  // namespace

void write_map_png(const std::string& path, const Plane<float>& values, const std::string& colormap, double low,
                   double high) {
  require_pixels(path, values.empty());
  const Module module = load_module();
  const auto color_map = function_of<varve_color_map_v1>(module, "varve_color_map_v1_run");
  const Window& window = values.window();
  const std::size_t width = std::size_t(window.width());
  std::vector<float> positions(width), rgb(3 * width);
  std::vector<unsigned char> bytes;
  bytes.reserve(window.pixels() * 3);
  std::array<char, 512> reason{};
  for (int y = window.y0; y < window.y1; ++y) {
    for (std::size_t x = 0; x < width; ++x) positions[x] = position(double(values.row(y)[x]), low, high);
    if (color_map(positions.data(), window.width(), colormap.c_str(), rgb.data(), reason.data(), reason.size()) != 0)
      throw Failure(ExitCode::output,
                    "Picture " + path + " cannot be colored with \"" + colormap + "\": " + reason.data() + ".");
    for (float value : rgb) bytes.push_back(to_byte(srgb(value)));
  }
  write_png(module, path, bytes, window);
}

void write_color_png(const std::string& path, const Plane<glm::vec4>& color, const DisplayTransform* transform) {
  require_pixels(path, color.empty());
  const Module module = load_module();
  const Window& window = color.window();
  std::vector<unsigned char> bytes;
  bytes.reserve(window.pixels() * 3);
  for (int y = window.y0; y < window.y1; ++y) {
    std::vector<glm::vec4> row(color.row(y), color.row(y) + window.width());
    if (transform) transform->apply_row(row.data(), window.width());
    for (const glm::vec4& pixel : row)
      for (int c = 0; c < 3; ++c) bytes.push_back(to_byte(transform ? pixel[c] : srgb(pixel[c])));
  }
  write_png(module, path, bytes, window);
}

}  // namespace varve
