// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace opp::mapping {

/// Base64 (RFC 4648) of any bytes, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace opp::mapping
