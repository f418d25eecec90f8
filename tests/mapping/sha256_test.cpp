// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/sha256.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace opp::mapping {
namespace {

TEST(Sha256, GivesThePublishedDigests) {
  // FIPS 180-2, appendix B.1, and the digest of the empty message.
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sha256_test.txt";
  std::ofstream(file, std::ios::binary) << "abc";
  EXPECT_EQ(sha256OfFile(file), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  std::ofstream(file, std::ios::binary | std::ios::trunc);
  EXPECT_EQ(sha256OfFile(file), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  std::filesystem::remove(file);
  EXPECT_THROW(sha256OfFile(file), std::runtime_error);
}

}  // namespace
}  // namespace opp::mapping
