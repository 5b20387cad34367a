// A plain OpenEXR C++ copy of chosen channels: what anyone would write, and the yardstick for whole-process times.
//   exr_copy_floor IN.%04d.exr OUT.%04d.exr FIRST LAST THREADS [CHANNEL...]
// Reads the channels (default: all) of the first part into frame buffers and writes them with the compression of the
// input.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace {

// printf style, with the one conversion %0Nd or %d.
std::string path_of(const std::string& pattern, int frame) {
  const std::size_t percent = pattern.find('%');
  if (percent == std::string::npos) return pattern;
  const std::size_t end = pattern.find('d', percent);
  const int width = std::atoi(pattern.substr(percent + 1, end - percent - 1).c_str());
  std::string digits = std::to_string(frame);
  if (digits.size() < std::size_t(width)) digits.insert(0, std::size_t(width) - digits.size(), '0');
  return pattern.substr(0, percent) + digits + pattern.substr(end + 1);
}

void copy(const std::string& from, const std::string& to, const std::vector<std::string>& names) {
  Imf::InputFile in(from.c_str());
  Imf::Header header = in.header();
  const Imath::Box2i window = header.dataWindow();
  const long width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;

  Imf::ChannelList channels;
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c)
    if (names.empty()) channels.insert(c.name(), c.channel());
  for (const std::string& name : names)
    if (const Imf::Channel* channel = in.header().channels().findChannel(name)) channels.insert(name, *channel);
  header.channels() = channels;

  std::vector<std::vector<char>> planes;
  Imf::FrameBuffer frame;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    const long size = c.channel().type == Imf::HALF ? 2 : 4;
    planes.emplace_back(std::size_t(width * height * size));
    char* base = planes.back().data() - (window.min.y * width + window.min.x) * size;
    frame.insert(c.name(), Imf::Slice(c.channel().type, base, std::size_t(size), std::size_t(size * width)));
  }
  in.setFrameBuffer(frame);
  in.readPixels(window.min.y, window.max.y);
  Imf::OutputFile out(to.c_str(), header);
  out.setFrameBuffer(frame);
  out.writePixels(int(height));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr, "usage: %s IN.%%04d.exr OUT.%%04d.exr FIRST LAST THREADS [CHANNEL...]\n", argv[0]);
    return 2;
  }
  try {
    Imf::setGlobalThreadCount(std::atoi(argv[5]));
    const std::vector<std::string> names(argv + 6, argv + argc);
    for (int f = std::atoi(argv[3]); f <= std::atoi(argv[4]); ++f)
      copy(path_of(argv[1], f), path_of(argv[2], f), names);
  } catch (const std::exception& caught) {
    std::fprintf(stderr, "%s\n", caught.what());
    return 1;
  }
  return 0;
}
