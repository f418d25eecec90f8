// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace opp::mapping {

/// A scan that was read.
struct ScanStamp {
  std::size_t scan_index = 0;  ///< see ScanFeatures
  double timestamp = 0.0;      ///< Unix time [s]
};

/// What became of one input rawlog.
struct SessionReport {
  std::string path;
  std::uintmax_t bytes = 0;
  std::string sha256;            ///< of the file, hexadecimal
  std::size_t frames_read = 0;   ///< 3D observations delivered by the reader
  std::size_t frames_used = 0;   ///< localized in the map; each has a line in trajectory.tum
  std::size_t frames_apart = 0;  ///< localized in a part that nothing proved to belong to the map
  std::size_t frames_lost = 0;   ///< read, but not localized
  std::size_t keyframes = 0;
  double path_length = 0.0;       ///< of the localized frames [m]
  std::size_t loop_closures = 0;  ///< loops and joins in which a keyframe of it was recognized
  std::vector<ScanStamp> scans;   ///< all that were read, in that order; not in run.json
};

/// What a run did: the contents of run.json.
struct RunReport {
  std::vector<SessionReport> sessions;
  std::map<std::string, std::size_t> counts;  ///< planes, lines, corners, keyframes, ...
  std::map<std::string, double> seconds;      ///< wall time per stage [s]
  std::vector<std::string> warnings;
};

}  // namespace opp::mapping
