// Prints of files: what is the same stays the same, and no change of a pixel passes.
#include "exr/file_print.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "base/error.h"
#include "exr/new_file.h"
#include "exr_test_files.h"

namespace varve::test {
namespace {

namespace fs = std::filesystem;

/// A part of 40x37 pixels, half and float, with noise; one value may be changed.
void write_noise(const fs::path& path, Compression compression, int changed = -1, const std::string& note = "") {
  const Window window{0, 0, 40, 37};
  std::mt19937 random(3);
  std::vector<RawPlane> planes;
  std::vector<OutputChannel> channels;
  for (const PixelType type : {PixelType::float16, PixelType::float32}) {
    RawPlane& plane = planes.emplace_back(make_raw_plane(type, window));
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 40 * int(bytes_per_pixel(type)); ++x) plane.storage.at(x, y) = std::byte(random() % 60);
  }
  if (changed >= 0) {
    std::byte& byte = planes[std::size_t(changed % 2)].storage.at(changed % 80, changed % 37);
    byte = byte ^ std::byte(1);
  }
  for (std::size_t i = 0; i < 2; ++i) channels.push_back({{i == 0 ? "G" : "Z", planes[i].type}, &planes[i]});
  Workers workers(1);
  const NewPart part{"", window, window, compression, channels, {string_attribute("note", note)}};
  write_new_file(path.string(), {&part, 1}, 1, workers);
}

TEST(FilePrint, TellsEveryChangeAndNothingElse) {
  Folder folder;
  fs::create_directory(folder.path / "other");
  for (const Compression compression : {Compression::none, Compression::rle, Compression::zips, Compression::zip,
                                        Compression::piz, Compression::pxr24, Compression::b44}) {
    SCOPED_TRACE(name_of(compression));
    write_noise(folder.path / "a.exr", compression);
    const std::uint64_t print = file_print((folder.path / "a.exr").string());
    fs::copy_file(folder.path / "a.exr", folder.path / "other/b.exr", fs::copy_options::overwrite_existing);
    fs::last_write_time(folder.path / "other/b.exr", fs::file_time_type::clock::now() - std::chrono::hours(1));
    EXPECT_EQ(file_print((folder.path / "other/b.exr").string()), print);
    if (compression != Compression::b44 && compression != Compression::pxr24) {  // which round some changes away
      std::set<std::uint64_t> seen = {print};
      for (int changed = 0; changed < 60; ++changed) {
        write_noise(folder.path / "c.exr", compression, changed);
        EXPECT_TRUE(seen.insert(file_print((folder.path / "c.exr").string())).second) << changed;
      }
    }
    write_noise(folder.path / "c.exr", compression, -1, "another camera");
    EXPECT_NE(file_print((folder.path / "c.exr").string()), print) << "headers are passed on";
  }
}

TEST(FilePrint, TellsWhatIsCutOffAndRefusesWhatIsNotThere) {
  Folder folder;
  const std::string path = (folder.path / "a.exr").string();
  write_noise(path, Compression::zip);
  const std::uint64_t print = file_print(path);
  fs::resize_file(path, fs::file_size(path) - 100);
  EXPECT_NE(file_print(path), print);
  fs::resize_file(path, 0);
  EXPECT_NE(file_print(path), print);
  EXPECT_THROW(file_print("missing.exr"), Failure);
}

TEST(FileIdentity, ChangesWithEveryWriteAndReplacement) {
  Folder folder;
  const std::string path = (folder.path / "a").string();
  EXPECT_FALSE(identity_of(path).there);
  std::ofstream(path) << "one";
  const FileIdentity first = identity_of(path);
  EXPECT_TRUE(first.there);
  EXPECT_EQ(identity_of(path), first);
  std::ofstream(path) << "three";
  EXPECT_NE(identity_of(path), first);
  std::ofstream(path + "2") << "one";
  fs::last_write_time(path + "2", fs::last_write_time(path));
  fs::rename(path + "2", path);
  EXPECT_NE(identity_of(path).inode, first.inode);
}

}  // namespace
}  // namespace varve::test
