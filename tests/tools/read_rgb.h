// R, G and B of one layer of an EXR file, for the tools beside the tests.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace varve::tools {

struct Rgb {
  Imath::Box2i window;
  std::vector<float> planes[3];
};

inline std::string joined(const std::string& layer, const char* component) {
  return layer.empty() ? component : layer + "." + component;
}

inline bool has_rgb(const Imf::ChannelList& channels, const std::string& layer) {
  return channels.findChannel(joined(layer, "R")) && channels.findChannel(joined(layer, "G")) &&
         channels.findChannel(joined(layer, "B"));
}

/// The layer itself, or for "auto" the bare one, or else the only one with R, G and B.
inline std::optional<std::string> layer_in(const Imf::ChannelList& channels, const std::string& wanted) {
  if (wanted != "auto") return has_rgb(channels, wanted) ? std::optional(wanted) : std::nullopt;
  if (has_rgb(channels, "")) return "";
  std::vector<std::string> found;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    const std::string name = c.name();
    if (name.size() < 3 || name.substr(name.size() - 2) != ".R") continue;
    if (has_rgb(channels, name.substr(0, name.size() - 2))) found.push_back(name.substr(0, name.size() - 2));
  }
  if (found.size() > 1) throw std::runtime_error("several layers have R, G, B: name one, such as " + found[0]);
  return found.empty() ? std::nullopt : std::optional(found[0]);
}

inline Rgb read_rgb(const std::string& path, const std::string& wanted) {
  Imf::MultiPartInputFile file(path.c_str());
  for (int p = 0; p < file.parts(); ++p) {
    const auto layer = layer_in(file.header(p).channels(), wanted);
    if (!layer) continue;
    Rgb image{file.header(p).dataWindow(), {}};
    const std::size_t width = std::size_t(image.window.max.x - image.window.min.x + 1);
    const std::size_t height = std::size_t(image.window.max.y - image.window.min.y + 1);
    Imf::FrameBuffer buffer;
    const char* components[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
      image.planes[c].resize(width * height);
      buffer.insert(joined(*layer, components[c]), Imf::Slice::Make(Imf::FLOAT, image.planes[c].data(), image.window,
                                                                    sizeof(float), sizeof(float) * width));
    }
    Imf::InputPart part(file, p);
    part.setFrameBuffer(buffer);
    part.readPixels(image.window.min.y, image.window.max.y);
    return image;
  }
  throw std::runtime_error(path + " has no R, G, B in layer \"" + wanted + "\"");
}

}  // namespace varve::tools
