// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <string>

namespace opp::mapping {

/// One 3D observation of a rawlog, free of MRPT types.
struct Scan {
  double timestamp = 0.0;  ///< Unix time of the observation [s]
  std::string sensor_label;
  std::size_t index = 0;  ///< 0-based position among the 3D observations of the rawlog
  PointCloud
      cloud_in_body;  ///< the sensor's pose on the body applied; viewpoint = sensor origin in body
};

}  // namespace opp::mapping
