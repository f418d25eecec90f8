// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/rawlog_reader.h"

#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <optional>
#include <regex>

namespace opp::mapping {

/// Numbers the 3D observations of a rawlog and picks those that RawlogOptions ask for.
class ScanSelection {
 public:
  /// \throws std::invalid_argument as RawlogReader.
  explicit ScanSelection(const RawlogOptions& options);

  /// To be called for each 3D observation in the order of the file: its index if it is wanted.
  /// Counts labels and what is not wanted.
  std::optional<std::size_t> take(const mrpt::obs::CObservation& scan, RawlogCounts& counts);

 private:
  RawlogOptions options_;
  std::regex label_;
  std::size_t next_index_ = 0;
};

}  // namespace opp::mapping
