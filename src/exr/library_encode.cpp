#include "exr/library_encode.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>

#include "base/error.h"
#include "exr/library_part.h"
#include "exr/library_slice.h"

namespace varve {
namespace {

// The library's idea of a stream over a file in memory.
class MemoryStream : public Imf::OStream {
 public:
  explicit MemoryStream(int descriptor) : Imf::OStream("memory"), descriptor_(descriptor) {}
  void write(const char bytes[], int count) override {
    for (int done = 0; done < count;) {
      const ssize_t n = ::pwrite(descriptor_, bytes + done, std::size_t(count - done), off_t(at_) + done);
      if (n <= 0 && errno != EINTR) throw Failure(ExitCode::output, "there is not enough memory to compress a part");
      if (n > 0) done += int(n);
    }
    at_ += std::uint64_t(count);
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override { at_ = to; }

 private:
  int descriptor_;
  std::uint64_t at_ = 0;
};

Imath::Box2i box_of(const Window& w) { return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}}; }

Imf::Header header_of(const Part& part) {
  Imf::Header header(box_of(part.display_window), box_of(part.data_window));
  header.compression() = Imf::Compression(int(part.compression));
  for (const Channel& channel : part.channels)
    header.channels().insert(channel.name, Imf::Channel(library_type(channel.type), channel.x_sampling,
                                                        channel.y_sampling, channel.perceptually_linear));
  const Attribute* level = part.attribute("dwaCompressionLevel");
  if (level && level->numbers.size() == 1) header.dwaCompressionLevel() = float(level->numbers[0]);
  return header;
}

}  // namespace

Container encode_by_library(const Part& part, const std::vector<const RawPlane*>& planes, int threads) {
  const int descriptor = ::memfd_create("varve-part", MFD_CLOEXEC);
  if (descriptor < 0)
    throw Failure(ExitCode::output, std::string("cannot compress a part in memory: ") + std::strerror(errno));
  try {
    Imf::setGlobalThreadCount(library_threads(threads));
    MemoryStream stream(descriptor);
    Imf::OutputFile file(stream, header_of(part), library_threads(threads));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < planes.size(); ++c) frame.insert(part.channels[c].name, library_slice(*planes[c]));
    file.setFrameBuffer(frame);
    file.writePixels(part.data_window.height());
  } catch (const std::exception& caught) {
    ::close(descriptor);
    if (dynamic_cast<const Failure*>(&caught) || dynamic_cast<const std::bad_alloc*>(&caught)) throw;
    const std::string reason = library_reason(caught.what());
    throw Failure(ExitCode::output, std::string("cannot compress pixels as ") + name_of(part.compression) +
                                        (reason.empty() ? "" : " (" + reason + ")") + "; choose another compression");
  }
  return open_container(InputBytes(descriptor, "compressed part"));
}

}  // namespace varve
