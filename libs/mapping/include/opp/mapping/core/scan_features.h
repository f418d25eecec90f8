// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/find_rims.h"
#include "opp/geometry/point_cloud.h"
#include "opp/params/primitive_params.h"
#include "opp/primitives/primitives.h"

#include <cstddef>
#include <utility>

namespace opp::mapping {

/// Session and ScanFeatures::scan_index of a scan: which it is of all of a run.
using ScanId = std::pair<int, std::size_t>;

/// What mapping keeps of one scan: samples, primitives and rims; raw points are gone.
struct ScanFeatures {
  double timestamp = 0.0;      ///< Unix time [s]
  int session = 0;             ///< which rawlog of the run it is from, in the order of mapping
  std::size_t scan_index = 0;  ///< position among the 3D observations of its rawlog
  OrientedCloud cloud_in_body;
  Primitives primitives_in_body;  ///< labels refer to the samples of cloud_in_body
  Rims rims_in_body;

  ScanId id() const { return {session, scan_index}; }
};

/// Samples, primitives and rims of one cloud, with detail (`ScanSurface`); time, session and index
/// are left as they are by default. Same result for every `threads`. \throws std::invalid_argument
/// as `makeScanSurface`, `detectPrimitives` and `findRims` do.
ScanFeatures detectFeatures(const PointCloud& cloud_in_body, const PrimitiveParams& params,
                            int threads = 1);

}  // namespace opp::mapping
