// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/version.h"

namespace opp::mapping {

std::string_view version() { return OPP_MAPPING_VERSION; }

}  // namespace opp::mapping
