// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace opp::mapping {

/// Version of opp-mapping, "major.minor.patch".
std::string_view version();

}  // namespace opp::mapping
