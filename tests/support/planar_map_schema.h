// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/run_command.h"

#include <filesystem>
#include <vector>

namespace opp::test {

/// Checks docs/planar_map.schema.json itself, and files against it, with Debian's
/// python3-jsonschema. Exit code 0: all follow it; else the messages say which file does not, and
/// where.
CommandResult validatePlanarMaps(const std::vector<std::filesystem::path>& files);

}  // namespace opp::test
