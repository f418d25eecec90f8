// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/io/rawlog_reader.h"

#include "common/command_line.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace opp::apps {

/// What the user asked opp-map for.
struct MapOptions {
  std::vector<std::filesystem::path> rawlogs;  ///< one a session, at least one
  std::filesystem::path output;
  mapping::RawlogOptions selection;
  std::optional<std::filesystem::path> initial_poses;
  mapping::MapperParams params;
  bool octomap = true;
  bool resume = false;
  bool force = false;
  bool quiet = false;
  int threads = 0;
};

/// Declares the flags of opp-map, parses and checks them.
/// \throws UsageError or TCLAP::ArgException for wrong usage, as loadParameters for the
/// configuration.
MapOptions parseOptions(CommandLine& line);

}  // namespace opp::apps
