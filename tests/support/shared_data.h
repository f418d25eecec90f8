// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string_view>

namespace opp::test {

/// Whether the folder of recorded sequences is there. It lies beside the checkout
/// (../shared/data) and is not part of the repository: the licences differ.
inline bool haveSharedData() { return std::filesystem::is_directory(OPP_SHARED_DATA_FOLDER); }

/// Path of a file of that folder, e.g. sharedData("fixtures/icl_nuim_frame.ply").
inline std::filesystem::path sharedData(std::string_view name) {
  return std::filesystem::path(OPP_SHARED_DATA_FOLDER) / name;
}

}  // namespace opp::test

/// First line of every test that reads recorded sequences (label data): skips it, saying so.
#define OPP_SKIP_WITHOUT_SHARED_DATA()                                                         \
  do {                                                                                         \
    if (!opp::test::haveSharedData()) {                                                        \
      GTEST_SKIP() << "NOT TESTED: the recorded sequences are not in " OPP_SHARED_DATA_FOLDER; \
    }                                                                                          \
  } while (false)
