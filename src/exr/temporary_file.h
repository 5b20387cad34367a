// A file that is not complete yet: hidden, beside its final name, and locked for as long as somebody writes it.
#pragma once

#include <cstddef>
#include <string>

namespace varve {

/// An empty file ".NAME.varve-HOST-PID-N.tmp" in the folder of `path`, HOST being eight digits made from the name of
/// the machine. The lock (flock) ends with the process, however that ends: what is not locked is a leftover. Without
/// commit() the file is removed. A symbolic link under `path` is replaced, not followed.
class TemporaryFile {
 public:
  /// Throws Failure(output) with path, reason and remedy.
  explicit TemporaryFile(const std::string& path);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  int descriptor() const { return descriptor_; }
  const std::string& name() const { return temporary_; }
  /// Flushes to the disk, gives the file its name, flushes the folder. Throws Failure(output).
  void commit();

 private:
  void create();
  void forget();

  std::string path_, folder_, temporary_;
  int descriptor_ = -1;
};

/// "cannot write 'out.exr': No space left on device; free some space or choose another folder", with exit code 5.
[[noreturn]] void refuse_output(const char* action, const std::string& path, int reason);

/// Folder of a path; "." for a bare name.
std::string folder_of(const std::string& path);

/// Removes temporary files that nobody writes any more: of this machine those that are not locked, of others those that
/// are besides a day old. Where locks do not work, those of this machine whose process is gone. Returns how many; never
/// throws, since what cannot be removed harms nobody.
std::size_t remove_leftovers(const std::string& folder);

}  // namespace varve
