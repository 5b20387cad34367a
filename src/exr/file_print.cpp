#include "exr/file_print.h"

#include <libdeflate.h>
#include <sys/stat.h>

#include <vector>

#include "exr/input_bytes.h"

namespace varve {

FileIdentity identity_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {std::uint64_t(status.st_dev),        std::uint64_t(status.st_ino),         std::uint64_t(status.st_size),
          std::int64_t(status.st_mtim.tv_sec), std::int64_t(status.st_mtim.tv_nsec), true};
}

std::uint64_t file_print(const std::string& path) {
  const InputBytes file(path);
  std::uint64_t print = add_to_print(kEmptyPrint, file.size());
  std::vector<char> block(1 << 20);
  for (std::uint64_t at = 0; at < file.size(); at += block.size()) {
    const std::size_t count = file.read_some(at, block.data(), block.size());
    print = add_to_print(print, libdeflate_crc32(0, block.data(), count));
  }
  return print;
}

}  // namespace varve
