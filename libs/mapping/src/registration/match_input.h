// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_moments.h"
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/registration/registration_params.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace opp::mapping {

/// A sample of a scan that is matched as a point.
struct ScanPoint {
  Eigen::Vector3f point_in_body;
  Eigen::Vector3f normal_in_body;
  float variance;      ///< of its offset along the normal [m²]
  int label;           ///< plane of the scan; −1: none
  double worth = 1.0;  ///< of one point, given all points of its surface; see effectiveCount
};

/// At most `params.max_points` samples, even over the directions of their normals. Points of one
/// plane share a part of their error, which their worth tells; all that are on no plane count as
/// one surface.
std::vector<ScanPoint> scanPoints(const ScanFeatures& scan, const SensorModel& sensor,
                                  const RegistrationParams& params);

/// The rims of a scan as points; together they are worth what one surface is.
std::vector<ScanPoint> rimPoints(const ScanFeatures& scan, const SensorModel& sensor);

/// Root mean square distance of the points from the body's origin [m]; 0 if there are none.
double rmsRange(const std::vector<ScanPoint>& points);

/// The scan's plane as four weighted pseudo-points that stand for all its samples: column k of the
/// factor of its moments is (s·x, s), and the residual n·(R(s·x) + s·t) + s·d has unit variance.
struct ScanPlane {
  Eigen::Matrix4d factor = Eigen::Matrix4d::Zero();
  PointMoments moments_in_body;
  double samples = 0.0;  ///< effective count
  int landmark = -1;
};

/// The planes of a scan, by index, associated with no landmark yet.
std::vector<ScanPlane> scanPlanes(const ScanFeatures& scan, const SensorModel& sensor);

}  // namespace opp::mapping
