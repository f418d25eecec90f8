// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/place.h"

#include "opp/mapping/core/se3.h"
#include "opp/mapping/frontend/insert_keyframe.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

Eigen::Isometry3d poseAt(int k) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.4 * k, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(0.2 * k, -0.1 * k, 1.3);
  return pose;
}

/// Keyframes of one room at their true poses; the planes of the first are landmarks, which the
/// others see too.
MapState mapOf(std::uint64_t room, int keyframes) {
  MapState map;
  for (int k = 0; k < keyframes; ++k) {
    test::SyntheticOptions options;
    options.spacing = 0.08;
    options.seed = static_cast<std::uint64_t>(k);
    const test::SyntheticScene scene = test::sampleScene(
        test::furnishedRoom(room), poseAt(k).translation(), poseAt(k).inverse(), options);
    MatchResult match;
    match.map_from_body = poseAt(k);
    for (std::size_t p = 0; p < scene.planes.size(); ++p) {
      const Plane in_map = transformed(poseAt(k), scene.planes[p]);
      for (std::size_t l = 0; l < map.landmarks.planes.size(); ++l) {
        const Plane& known = map.landmarks.planes[l].plane_in_map;
        if (angleBetween(known, in_map) < 1e-6 && std::abs(known.d() - in_map.d()) < 1e-6)
          match.planes.push_back({static_cast<int>(p), static_cast<int>(l)});
      }
    }
    insertKeyframe(test::trueFeatures(scene), match, SensorModel(), map);
  }
  return map;
}

TEST(Place, OfOneKeyframeIsThatKeyframe) {
  const MapState map = mapOf(1, 1);
  const Place place = placeOf(map, 0, {0}, MapperParams());
  const ScanFeatures& scan = map.keyframes[0].features;
  EXPECT_EQ(place.keyframe, 0);
  EXPECT_EQ(place.features.primitives_in_body.corners.size(),
            scan.primitives_in_body.corners.size());
  EXPECT_EQ(place.features.primitives_in_body.labels.size(), place.features.cloud_in_body.size());
  EXPECT_LE(place.features.cloud_in_body.size(), scan.cloud_in_body.size());
  EXPECT_GT(place.features.cloud_in_body.size(), scan.cloud_in_body.size() / 2);
}

TEST(Place, HasItsSamplesAndCornersOnItsPlanesInTheFrameOfTheKeyframe) {
  for (std::uint64_t room = 1; room <= 50; ++room) {
    const MapState map = mapOf(room, 3);
    const Place place = placeOf(map, 1, {0, 1, 2}, MapperParams());
    const Primitives& primitives = place.features.primitives_in_body;
    const OrientedCloud& cloud = place.features.cloud_in_body;
    ASSERT_EQ(primitives.labels.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (primitives.labels[i] < 0) continue;
      const Plane& plane =
          primitives.planes.at(static_cast<std::size_t>(primitives.labels[i])).plane;
      ASSERT_NEAR(plane.signedDistance(cloud.points[i].cast<double>()), 0.0, 1e-5);
      ASSERT_GT(plane.normal().dot(cloud.normals[i].cast<double>()), 0.99);
    }
    EXPECT_GE(primitives.corners.size(),
              map.keyframes[1].features.primitives_in_body.corners.size());
    for (const Corner& corner : primitives.corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Plane& plane = primitives.planes.at(static_cast<std::size_t>(corner.planes[k])).plane;
        EXPECT_NEAR(plane.signedDistance(corner.position), 0.0, 1e-9);
        EXPECT_NEAR(std::abs(corner.cloud_from_corner.col(static_cast<int>(k)).dot(plane.normal())),
                    1.0, 1e-9);
      }
    }
    for (const PlanePrimitive& plane : primitives.planes) {
      EXPECT_GT(plane.support, 0);
      EXPECT_GT(plane.area, 0.0);
      EXPECT_FALSE(plane.moments.empty());
      EXPECT_NEAR(plane.plane.signedDistance(plane.moments.mean()), 0.0, 1e-6);
    }
  }
}

}  // namespace
}  // namespace opp::mapping
