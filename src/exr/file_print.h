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

/// FNV-1a, 64 bits, over what an OpenEXR file holds; the same wherever and whenever the file lies. Equal prints: the
/// same headers, chunk tables and pixels. Of the chunks that zlib made (ZIP, ZIPS, PXR24) only the checksum is read
/// that zlib put at their ends (RFC 1950: Adler-32 of all that is in them); of all others every byte. So a ZIP file
/// costs its chunk table and a few bytes for each chunk, any other one reading it. What is damaged counts by its place
/// in the file. Throws Failure(input) where the header cannot be read.
std::uint64_t file_print(const std::string& path);

/// Goes on with FNV-1a, eight bytes of a number, least first.
inline std::uint64_t add_to_print(std::uint64_t print, std::uint64_t number) {
  for (int i = 0; i < 8; ++i) print = (print ^ ((number >> (8 * i)) & 255)) * 1099511628211ull;
  return print;
}
inline constexpr std::uint64_t kEmptyPrint = 14695981039346656037ull;

}  // namespace varve
