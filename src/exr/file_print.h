// Whether a file is still the one that was read: at a glance while a run lasts, by its contents from run to run.
#pragma once

#include <cstdint>
#include <string>

namespace varve {

/// What the file system tells of a file; any write or replacement changes it.
struct FileIdentity {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  ///< of the last change of its contents
  bool there = false;                         ///< false: it could not be looked at
  bool operator==(const FileIdentity&) const = default;
};
FileIdentity identity_of(const std::string& path);

/// FNV-1a, 64 bits, over the size of a file and the CRC-32 of each of its MiB: the same wherever and whenever the file
/// lies. It costs reading the file. Less would not do: the checksums that zlib puts at the ends of ZIP chunks are taken
/// of differences, and a thing that moves within a chunk leaves them as they are. Throws Failure(input) where the file
/// cannot be read.
std::uint64_t file_print(const std::string& path);

/// Goes on with FNV-1a, eight bytes of a number, least first.
inline std::uint64_t add_to_print(std::uint64_t print, std::uint64_t number) {
  for (int i = 0; i < 8; ++i) print = (print ^ ((number >> (8 * i)) & 255)) * 1099511628211ull;
  return print;
}
inline constexpr std::uint64_t kEmptyPrint = 14695981039346656037ull;

}  // namespace varve
