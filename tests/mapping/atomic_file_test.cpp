// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/atomic_file.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <ostream>
#include <stdexcept>

namespace opp::mapping {
namespace {

using Names = std::vector<std::string>;

TEST(WriteFileAtomically, MakesAndReplacesAFile) {
  const test::TempFolder folder;
  writeFileAtomically(folder / "a", [](std::ostream& os) { os << "one\r\n"; });
  EXPECT_EQ(test::readFile(folder / "a"), "one\r\n");
  writeFileAtomically(folder / "a", [](std::ostream& os) { os << "2"; });
  EXPECT_EQ(test::readFile(folder / "a"), "2");
  EXPECT_EQ(folder.contents(), Names{"a"});
}

TEST(WriteFileAtomically, FailureKeepsTheOldFileAndLeavesNothingElse) {
  const test::TempFolder folder;
  test::writeFile(folder / "a", "old");
  const auto half = [](std::ostream& os) {
    os << "half";
    throw std::out_of_range("the writer's own");
  };
  EXPECT_THROW(writeFileAtomically(folder / "a", half), std::out_of_range);
  EXPECT_THROW(writeFileAtomically(folder / "new", half), std::out_of_range);
  EXPECT_EQ(test::readFile(folder / "a"), "old");
  EXPECT_EQ(folder.contents(), Names{"a"});
}

TEST(WriteFileAtomically, FollowsALink) {
  const test::TempFolder folder;
  test::writeFile(folder / "target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  writeFileAtomically(folder / "link", [](std::ostream& os) { os << "new"; });
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(test::readFile(folder / "target"), "new");
}

TEST(WriteFileAtomically, WritesToADeviceWithoutReplacingIt) {
  writeFileAtomically("/dev/null", [](std::ostream& os) { os << "gone"; });
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(WriteFileAtomically, FullDiskIsAnError) {
  EXPECT_THROW(writeFileAtomically("/dev/full", [](std::ostream& os) { os << "x"; }),
               std::runtime_error);
}

TEST(WriteFileAtomically, RefusesFoldersAndMissingFolders) {
  const test::TempFolder folder;
  const auto write = [](std::ostream& os) { os << "x"; };
  EXPECT_THROW(writeFileAtomically(folder.path(), write), std::runtime_error);
  EXPECT_THROW(writeFileAtomically(folder / "missing/a", write), std::runtime_error);
  EXPECT_THROW(writeFileAtomically("", write), std::runtime_error);
  EXPECT_TRUE(folder.contents().empty());
}

TEST(ReplaceFileAtomically, GivesATemporaryNameWithTheSameEnd) {
  const test::TempFolder folder;
  replaceFileAtomically(folder / "map.ot", [&](const std::filesystem::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder.path());
    EXPECT_EQ(temporary.extension(), ".ot");
    test::writeFile(temporary, "tree");
  });
  EXPECT_EQ(test::readFile(folder / "map.ot"), "tree");
  EXPECT_EQ(folder.contents(), Names{"map.ot"});
}

TEST(ReplaceFileAtomically, AWriterThatWritesNothingIsAnError) {
  const test::TempFolder folder;
  EXPECT_THROW(replaceFileAtomically(folder / "a", [](const std::filesystem::path&) {}),
               std::runtime_error);
}

}  // namespace
}  // namespace opp::mapping
