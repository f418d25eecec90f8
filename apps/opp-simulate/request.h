// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/rawlog_writer.h"
#include "opp/mapping/simulation/ground_truth.h"
#include "opp/mapping/simulation/simulator.h"

#include "common/command_line.h"

#include <filesystem>
#include <optional>
#include <string>

namespace opp::apps {

/// What the flags ask for.
struct SimulateRequest {
  std::string scene;
  mapping::SimulationOptions simulation;
  mapping::RawlogWriterOptions rawlog;
  std::filesystem::path output;
  bool odometry = false;
  std::optional<std::filesystem::path> per_frame_truth;
  int min_pixels = mapping::GroundTruthParams().min_pixels;
  int threads = 0;
  bool quiet = false;
};

/// Declares the flags, parses the command line and checks what a single flag can get wrong.
/// \throws UsageError, TCLAP::ArgException.
SimulateRequest parseRequest(CommandLine& line);

}  // namespace opp::apps
