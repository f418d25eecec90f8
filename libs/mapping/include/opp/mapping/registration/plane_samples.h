// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_moments.h"
#include "opp/mapping/core/scan_features.h"

#include <vector>

namespace opp::mapping {

/// Variance of a sample's offset along its normal [m²].
float sampleVariance(const OrientedCloud& cloud, std::size_t sample, const SensorModel& sensor);

/// How many independent samples `count` samples are worth that share the part `noise_correlation`
/// of their error: distortion, calibration and quantization do not average out over a surface. At
/// most 1/noise_correlation.
double effectiveCount(double count, const SensorModel& sensor);

/// All samples of one plane of a scan, weighted as what they are worth together.
struct PlaneSamples {
  PointMoments moments_in_body;  ///< weights 1/variance [1/m²], scaled to `effective_count`
  double effective_count = 0.0;
};

/// The samples of each plane of a scan, by index of the plane; of a strip they are worth the less
/// the more what its rims take in may shift it (RimError). O(samples).
std::vector<PlaneSamples> planeSamples(const ScanFeatures& scan, const SensorModel& sensor);

}  // namespace opp::mapping
