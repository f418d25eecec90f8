// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detect_primitives.h"
#include "opp/mapping/io/cloud_file.h"

#include "support/shared_data.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace opp::mapping {
namespace {

TEST(DetectPrimitives, FindsRoomAndSofaForEverySeed) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const PointCloud cloud = readCloudFile(test::sharedData("fixtures/icl_nuim_frame.ply"));
  // Two corners of the room, three of the sofa.
  const std::vector<Eigen::Vector3d> corners = {{-1.71, 1.33, 3.35},
                                                {-1.71, -1.17, 3.35},
                                                {1.40, -0.65, 2.35},
                                                {-0.38, -0.65, 2.31},
                                                {-0.38, -0.49, 2.31}};
  PrimitiveParams params;
  params.sensor.min_range = 0.0;
  for (params.voting.seed = 1; params.voting.seed <= 100; ++params.voting.seed) {
    SCOPED_TRACE(params.voting.seed);
    ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling);
    const Primitives found = detectPrimitives(cloud, surface, params);
    EXPECT_GE(found.planes.size(), 9U);
    for (const Eigen::Vector3d& corner : corners) {
      EXPECT_TRUE(std::any_of(found.corners.begin(), found.corners.end(), [&](const Corner& c) {
        return (c.position - corner).norm() < 0.02;  // 1 cm for the rounding above, 1 for noise
      })) << corner.transpose();
    }
  }
}

}  // namespace
}  // namespace opp::mapping
