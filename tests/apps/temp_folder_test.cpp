// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp::test {
namespace {

TEST(TempFolder, GoesWithAllItHolds) {
  std::filesystem::path path;
  {
    const TempFolder folder;
    path = folder.path();
    std::filesystem::create_directory(folder / "b");
    writeFile(folder / "b/.hidden", "x");
    writeFile(folder / "a", "y");
    EXPECT_EQ(folder.contents(), (std::vector<std::string>{"a", "b", "b/.hidden"}));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TempFolder, FilesKeepEveryByte) {
  const TempFolder folder;
  const std::string bytes("\0\r\n\xff", 4);
  writeFile(folder / "bytes", bytes);
  EXPECT_EQ(readFile(folder / "bytes"), bytes);
}

TEST(TempFolder, ReadingAMissingFileThrows) {
  const TempFolder folder;
  EXPECT_THROW(readFile(folder / "missing"), std::runtime_error);
}

}  // namespace
}  // namespace opp::test
