// Which files --extra finds, and lists of renders that are not what they claim.
#include "plan/extra_files.h"

#include <gtest/gtest.h>

#include "exr_test_files.h"

namespace varve {
namespace {

using test::Folder;
using test::spill;

TEST(ExtraFiles, AStarStandsForAnythingInTheName) {
  Folder folder;
  for (const char* name : {"extra.r000.s00.0009.exr", "extra.r000.s01.0009.exr", "extra.r1.0010.exr", "extra.0009.exr",
                           "other.0009.exr", "extra.a.0009.exr.tmp"})
    spill(folder / name, "");
  const auto found = find_extra_files({folder / "extra.*.####.exr", folder / "extra.*s01.####.exr"}, {8, 9, 10});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found.at(9),
            (std::vector<std::string>{folder / "extra.r000.s00.0009.exr", folder / "extra.r000.s01.0009.exr"}));
  EXPECT_EQ(found.at(10), std::vector<std::string>{folder / "extra.r1.0010.exr"});
  EXPECT_EQ(find_extra_files({folder / "*.####.exr"}, {9}).at(9).size(), 4u);
  EXPECT_EQ(find_extra_files({folder / "extra.####.exr"}, {9}).at(9).size(), 1u);
  EXPECT_TRUE(find_extra_files({folder / "nowhere/*.####.exr"}, {9}).empty());
  EXPECT_THROW(find_extra_files({folder / "extra.exr"}, {8, 9}), Failure);
  EXPECT_TRUE(find_extra_files({folder / "extra.exr"}, {9}).empty());
}

TEST(ExtraFiles, ListsThatAreNoneAreRefused) {
  Folder folder;
  const std::string path = folder / "list.json";
  for (const char* text :
       {"", "{}", "[]", "{\"renders\": {}}", "{\"renders\": [7]}", "{\"renders\": [{\"files\": [\"a\"]}]}",
        "{\"renders\": [{\"window\": [0, 0, 1e300, 4], \"files\": [\"a\"]}]}",
        "{\"renders\": [{\"window\": [0, 0, 4.5, 4], \"files\": [\"a\"]}]}",
        "{\"renders\": [{\"window\": [0, 0, 4, 4], \"files\": \"a\"}]}"}) {
    spill(path, text);
    EXPECT_THROW(read_extra_list(path), Failure) << text;
  }
  EXPECT_THROW(read_extra_list(folder / "none.json"), Failure);
  spill(path,
        "{\"renders\": [{\"window\": [1, 2, 5, 6], \"jitter\": [[0.25, -0.5], [7, 0]], \"files\": [\"a\", \"b\", "
        "\"c\"]}]}");
  const auto list = read_extra_list(path);
  EXPECT_EQ(list.at("a").window, (std::array<int, 4>{1, 2, 5, 6}));
  ASSERT_TRUE(list.at("a").jitter);
  EXPECT_EQ(list.at("a").jitter->y, -0.5);
  EXPECT_FALSE(list.at("b").jitter) << "not within a pixel";
  EXPECT_FALSE(list.at("c").jitter) << "not told";
}

}  // namespace
}  // namespace varve
