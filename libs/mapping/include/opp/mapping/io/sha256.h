// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace opp::mapping {

/// SHA-256 of a file's bytes, 64 hexadecimal digits. \throws std::runtime_error if it cannot be
/// read.
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace opp::mapping
