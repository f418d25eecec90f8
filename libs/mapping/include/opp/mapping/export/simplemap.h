// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/rawlog_reader.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <map>
#include <vector>

namespace opp::mapping {

/// Keyframes of one rawlog.
struct SimplemapSource {
  std::filesystem::path rawlog;
  std::map<std::size_t, Eigen::Isometry3d> keyframes;  ///< map_from_body by Scan::index
};

/// Writes an MRPT simplemap (.simplemap): pose and observation of each keyframe, for
/// observations2map and other tools. The observations are read from the rawlog once more and
/// written one by one, so memory does not grow with their number. Depth images get some thousand of
/// their points beside them, without which MRPT 2.5 cannot insert them into maps; images outside of
/// the rawlog are embedded, because the simplemap lies elsewhere. \param selection as the scans
/// were read. Whole or not at all. \throws
/// std::runtime_error if the rawlog cannot be read, lacks one of the keyframes, or the file cannot
/// be written.
void writeSimplemap(const std::filesystem::path& path, const std::vector<SimplemapSource>& sources,
                    const RawlogOptions& selection);

}  // namespace opp::mapping
