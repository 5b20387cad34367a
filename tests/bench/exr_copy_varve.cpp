// The same copy as exr_copy_floor through read_channels and write_frame; same arguments. Reports where the time went.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/error.h"
#include "exr/read_frame.h"
#include "exr/sequence.h"
#include "exr/write_frame.h"

int main(int argc, char** argv) {
  using namespace varve;
  if (argc < 6) {
    std::fprintf(stderr, "usage: %s IN.%%04d.exr OUT.%%04d.exr FIRST LAST THREADS [CHANNEL...]\n", argv[0]);
    return 2;
  }
  using Clock = std::chrono::steady_clock;
  double read = 0, write = 0;
  try {
    Workers workers(std::atoi(argv[5]));
    const SequencePattern in = SequencePattern::parse(argv[1]), out = SequencePattern::parse(argv[2]);
    for (int f = std::atoi(argv[3]); f <= std::atoi(argv[4]); ++f) {
      const Clock::time_point start = Clock::now();
      const FileHeader header = read_header(in.path(f));
      const Part& part = header.parts[0];
      std::vector<ChannelRef> refs;
      for (std::size_t c = 0; c < part.channels.size() && argc == 6; ++c) refs.push_back({0, 0, int(c)});
      for (int i = 6; i < argc; ++i)
        if (const auto c = part.channel(argv[i])) refs.push_back({0, 0, *c});
      const FramePixels frame = read_channels(header, refs, workers);
      const Clock::time_point middle = Clock::now();
      std::vector<OutputPart> parts(1);
      for (const ChannelRef& ref : refs)
        parts[0].channels.push_back({part.channels[std::size_t(ref.channel)], &frame[ref]});
      write_frame(out.path(f), header, parts, {}, workers);
      read += std::chrono::duration<double>(middle - start).count();
      write += std::chrono::duration<double>(Clock::now() - middle).count();
    }
  } catch (const Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return int(failure.code());
  }
  std::printf("read %.1f ms, write %.1f ms\n", 1000 * read, 1000 * write);
  return 0;
}
