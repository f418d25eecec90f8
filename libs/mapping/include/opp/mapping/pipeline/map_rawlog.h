// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/rawlog_reader.h"
#include "opp/mapping/pipeline/mapping_run.h"

#include <filesystem>
#include <functional>

namespace opp::mapping {

/// Called after each scan with the part of the rawlog that is done, in [0, 1], and the number of
/// scans so far.
using ProgressCallback = std::function<void(double, std::size_t)>;

/// Which scans of a rawlog to map, and how.
struct MapRawlogOptions {
  RawlogOptions selection;
  Trajectory initial_poses;  ///< predictions of map_from_body that go before the rawlog's odometry;
                             ///< may be empty
  int threads = 0;           ///< <= 0: all cores
};

/// Feeds all wanted scans of a rawlog to the mapper as the next session of the run; of a session
/// that was read in part, those that are left: the result is the same as without the break. Damage
/// of the file becomes a warning of the report; what was read before is kept. If `progress` throws,
/// the run has all scans so far, and may go on.
/// \throws std::runtime_error if the rawlog cannot be read or holds no 3D observation that is
/// wanted.
void mapRawlog(const std::filesystem::path& rawlog, const MapRawlogOptions& options,
               const PrimitiveParams& params, const ProgressCallback& progress, MappingRun& run);

/// Finishes the mapper and completes the report: what became of each session's scans, and a warning
/// for each that is not wholly in the map. To be called once, after the last session. `threads`
/// <= 0: all cores; no influence on the result.
void finishMapping(MappingRun& run, int threads = 1);

}  // namespace opp::mapping
