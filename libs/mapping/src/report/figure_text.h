// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace opp::mapping {

/// "1.23 m"
std::string metresText(double length);

/// "1.2 MB" of a number of megabytes.
std::string megabytesText(double megabytes);

/// "2024-02-29 12:00:00 UTC"; seconds where the stamp is no calendar's: before 1970, or absurd.
std::string momentText(double unix_time);

}  // namespace opp::mapping
