// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace opp::mapping {

/// A 16-bit grey image as it is stored: rows from the top.
struct Gray16Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> pixels;  ///< row by row
};

/// Reads a PNG file bit by bit: no scaling, no gamma. \throws std::runtime_error that names the
/// file if it cannot be read, is damaged, or is not a 16-bit grey image.
Gray16Image readGray16Png(const std::filesystem::path& path);

}  // namespace opp::mapping
