// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace opp::test {

/// Writes a grey PNG of 16 (or, with `bits`, 8) bits a pixel. \throws std::runtime_error if the
/// file cannot be written.
void writeGrayPng(const std::filesystem::path& path, int width, int height,
                  const std::vector<std::uint16_t>& pixels, int bits = 16);

}  // namespace opp::test
