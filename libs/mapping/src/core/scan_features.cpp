// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/scan_features.h"

#include "opp/cloud/oriented_cloud.h"
#include "opp/detect_primitives.h"

#include <utility>

namespace opp::mapping {

ScanFeatures detectFeatures(const PointCloud& cloud_in_body, const PrimitiveParams& params,
                            int threads) {
  ScanFeatures features;
  ScanSurface surface = makeScanSurface(cloud_in_body, params.sensor, params.sampling);
  features.primitives_in_body = detectPrimitives(cloud_in_body, surface, params, threads);
  features.cloud_in_body = std::move(surface.samples);
  features.rims_in_body = findRims(cloud_in_body, params.sensor, params.rims);
  return features;
}

}  // namespace opp::mapping
