// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/primitive_error.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/core/move_planar_map.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

/// Plane with one square of side 2·half around `centre`; t1, t2, n right-handed.
PlanarMapPlane square(int id, const Eigen::Vector3d& centre, const Eigen::Vector3d& normal,
                      double half) {
  PlanarMapPlane plane;
  plane.id = id;
  plane.plane = Plane::fromPointNormal(centre, normal);
  plane.centroid = centre;
  const Eigen::Matrix<double, 3, 2> axes = half * tangentBasis(plane.plane.normal());
  PlanarPolygon polygon;
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    polygon.outer.push_back(centre + axes * Eigen::Vector2d(u, v));
  }
  plane.polygons.push_back(polygon);
  return plane;
}

/// Room [−2, 2]³ seen from inside: 6 planes, 12 lines, 8 corners; plane 2k is at −2 along axis k
/// and plane 2k + 1 at +2.
PlanarMap room() {
  PlanarMap map;
  for (int k = 0; k < 3; ++k) {
    for (const int side : {-1, 1}) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
      map.planes.push_back(square(2 * k + (side > 0), 2.0 * side * axis, -side * axis, 2.0));
    }
  }
  for (PlanarMapPlane& plane : map.planes) {
    for (int other = 0; other < 6; ++other) {
      if (other / 2 != plane.id / 2) plane.orthogonal_to.push_back(other);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3;
    const int b = (k + 2) % 3;
    for (int s = 0; s < 4; ++s) {
      PlanarMapLine line;
      line.id = 4 * k + s;
      line.planes = {2 * a + s % 2, 2 * b + s / 2};
      line.start[k] = -2.0;
      line.end[k] = 2.0;
      line.start[a] = line.end[a] = s % 2 == 1 ? 2.0 : -2.0;
      line.start[b] = line.end[b] = s / 2 == 1 ? 2.0 : -2.0;
      map.lines.push_back(line);
    }
  }
  for (int c = 0; c < 8; ++c) {
    PlanarMapCorner corner;
    corner.id = c;
    for (int k = 0; k < 3; ++k) {
      const int bit = (c >> k) & 1;
      corner.planes[static_cast<std::size_t>(k)] = 2 * k + bit;
      corner.position[k] = bit == 1 ? 2.0 : -2.0;
    }
    map.corners.push_back(corner);
  }
  return map;
}

void expectPerfect(const PrimitiveTally& tally, std::size_t count, double tolerance) {
  EXPECT_EQ(tally.gt, count);
  EXPECT_EQ(tally.est, count);
  EXPECT_EQ(tally.precision(), 1.0);
  EXPECT_EQ(tally.recall(), 1.0);
  EXPECT_LE(statisticsOf(tally.angles).max, tolerance);
  EXPECT_LE(statisticsOf(tally.distances).max, tolerance);
}

TEST(ComparePrimitives, TruthAgainstItselfIsPerfect) {
  const PrimitiveTallies tallies = comparePrimitives(room(), room());
  expectPerfect(tallies.planes, 6, 0.0);
  expectPerfect(tallies.lines, 12, 0.0);
  expectPerfect(tallies.corners, 8, 0.0);
  EXPECT_EQ(tallies.orthogonality.claimed, 12u);
  EXPECT_EQ(tallies.orthogonality.checked, 12u);
  EXPECT_EQ(tallies.orthogonality.falseRate(), 0.0);
}

TEST(ComparePrimitives, DoesNotDependOnTheFrameOrTheOrder) {
  test::Random random(111);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d gt_from_est = random.pose(10.0);
    PlanarMap est = movedPlanarMap(gt_from_est.inverse(), room());
    std::reverse(est.planes.begin(), est.planes.end());
    std::reverse(est.lines.begin(), est.lines.end());
    std::reverse(est.corners.begin(), est.corners.end());
    const PrimitiveTallies tallies = comparePrimitives(room(), est, {}, gt_from_est);
    // Rounding of coordinates of 10 m and of angles from quaternions.
    expectPerfect(tallies.planes, 6, 1e-12);
    expectPerfect(tallies.lines, 12, 1e-12);
    expectPerfect(tallies.corners, 8, 1e-12);
  }
}

TEST(ComparePrimitives, KnownShiftIsTheOffsetOfThePlanesThatItMoves) {
  // 3 cm along x moves two of six planes, eight of twelve lines (those not along x) and all
  // corners.
  Eigen::Isometry3d shift = Eigen::Isometry3d::Identity();
  shift.translation().x() = 0.03;
  const PrimitiveTallies tallies = comparePrimitives(room(), movedPlanarMap(shift, room()));
  EXPECT_EQ(tallies.planes.recall(), 1.0);
  EXPECT_EQ(std::count_if(tallies.planes.distances.begin(), tallies.planes.distances.end(),
                          [](double d) { return std::abs(d - 0.03) < 1e-12; }),
            2);
  EXPECT_EQ(std::count_if(tallies.lines.distances.begin(), tallies.lines.distances.end(),
                          [](double d) { return std::abs(d - 0.03) < 1e-12; }),
            8);
  EXPECT_NEAR(statisticsOf(tallies.corners.distances).median, 0.03, 1e-12);
  EXPECT_LT(statisticsOf(tallies.planes.angles).max, 1e-12);
}

TEST(ComparePrimitives, KnownTiltAboutItsCentroidIsTheAngleOfAPlane) {
  PlanarMap gt, est;
  gt.planes.push_back(square(0, {1, 2, 3}, {0, 0, 1}, 1.0));
  est.planes.push_back(
      square(7, {1, 2, 3}, {std::sin(degToRad(2.0)), 0, std::cos(degToRad(2.0))}, 1.0));
  const PrimitiveTallies tallies = comparePrimitives(gt, est);
  ASSERT_EQ(tallies.planes.angles.size(), 1u);
  EXPECT_NEAR(tallies.planes.angles[0], degToRad(2.0), 1e-12);
  EXPECT_NEAR(tallies.planes.distances[0], 0.0, 1e-12);
}

TEST(ComparePrimitives, WhatIsTooFarTiltedOrElsewhereIsNotTheSame) {
  PlanarMap gt;
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 1.0));
  const double six_degrees = degToRad(6.0);
  for (const PlanarMapPlane& wrong :
       {square(0, {0, 0, 0.051}, {0, 0, 1}, 1.0),                                      // offset
        square(0, {0, 0, 0}, {std::sin(six_degrees), 0, std::cos(six_degrees)}, 1.0),  // angle
        square(0, {1.1, 0, 0}, {0, 0, 1}, 1.0),    // overlap 45 %
        square(0, {0, 0, 0}, {0, 0, 1}, 0.45),     // covers 20 %
        square(0, {0, 0, 0}, {0, 0, -1}, 1.0)}) {  // other side
    PlanarMap est;
    est.planes.push_back(wrong);
    const PrimitiveTallies tallies = comparePrimitives(gt, est);
    EXPECT_EQ(tallies.planes.precision(), 0.0) << wrong.plane;
    EXPECT_EQ(tallies.planes.recall(), 0.0);
    EXPECT_TRUE(tallies.planes.angles.empty());
  }
}

TEST(ComparePrimitives, DuplicatesAreWrongAndFragmentsToo) {
  PlanarMap gt;
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 1.0));
  PlanarMap est = gt;
  est.planes.push_back(square(1, {0, 0, 0.01}, {0, 0, 1}, 1.0));
  const PrimitiveTallies tallies = comparePrimitives(gt, est);
  EXPECT_EQ(tallies.planes.precision(), 0.5);
  EXPECT_EQ(tallies.planes.recall(), 1.0);
  EXPECT_EQ(tallies.planes.distances.at(0), 0.0);  // the better of the two is the match
}

TEST(ComparePrimitives, CoplanarTruePlanesMayShareOneEstimatedPlane) {
  PlanarMap gt;
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 1.0));
  gt.planes.push_back(square(1, {5, 0, 0}, {0, 0, 1}, 1.0));
  gt.planes.push_back(square(2, {10, 0, 0.02}, {0, 0, 1}, 1.0));  // near, but another height
  PlanarMap est;
  est.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 1.0));
  for (const double x : {5.0, 10.0}) {
    est.planes[0].polygons.push_back(square(0, {x, 0, 0}, {0, 0, 1}, 1.0).polygons[0]);
  }
  const PrimitiveTallies tallies = comparePrimitives(gt, est);
  EXPECT_EQ(tallies.planes.gt_found, 2u);
  EXPECT_EQ(tallies.planes.est_correct, 1u);
}

TEST(ComparePrimitives, PlanesWithoutPolygonsAreComparedByGeometry) {
  PlanarMap gt;
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 1.0));
  PlanarMap est = gt;
  est.planes[0].polygons.clear();
  EXPECT_EQ(comparePrimitives(gt, est).planes.recall(), 1.0);
  EXPECT_EQ(comparePrimitives(est, gt).planes.recall(), 1.0);
}

TEST(ComparePrimitives, PlanesWithoutPolygonsMustLieWhereTheTrueOneIs) {
  PlanarMap gt;
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 1.0));
  PlanarMap est = gt;
  est.planes[0].polygons.clear();
  for (const double x : {-1.04, 0.3, 1.04}) {
    est.planes[0].centroid = {x, 0.5, 0.02};
    EXPECT_EQ(comparePrimitives(gt, est).planes.precision(), 1.0) << x;
  }
  est.planes[0].centroid = {1.06, 0.5, 0.02};  // farther than max_offset
  EXPECT_EQ(comparePrimitives(gt, est).planes.precision(), 0.0);
}

TEST(ComparePrimitives, FindingWhatWasBarelySeenIsNeitherRightNorWrong) {
  PlanarMap gt = room();
  // All but the floor and what it takes part in was barely seen.
  const auto move_out = [](auto& from, auto& to, const auto& stays) {
    for (const auto& element : from) {
      if (!stays(element)) to.push_back(element);
    }
    from.erase(std::remove_if(from.begin(), from.end(), [&](const auto& e) { return !stays(e); }),
               from.end());
  };
  move_out(gt.planes, gt.barely_seen.planes, [](const auto& plane) { return plane.id == 4; });
  move_out(gt.lines, gt.barely_seen.lines, [](const auto& line) { return line.id == 0; });
  move_out(gt.corners, gt.barely_seen.corners, [](const auto& corner) { return corner.id < 3; });
  PrimitiveTallies tallies = comparePrimitives(gt, room());
  EXPECT_EQ(tallies.planes.est_correct, 1u);
  EXPECT_EQ(tallies.planes.est_neutral, 5u);
  EXPECT_EQ(tallies.lines.est_neutral, 11u);
  EXPECT_EQ(tallies.corners.est_neutral, 5u);
  for (const PrimitiveTally& tally : {tallies.planes, tallies.lines, tallies.corners}) {
    EXPECT_EQ(tally.precision(), 1.0);
    EXPECT_EQ(tally.recall(), 1.0);
  }
  EXPECT_EQ(tallies.orthogonality.checked, 12u);  // their true angles are known all the same
  tallies.add(tallies);
  EXPECT_EQ(tallies.lines.est_neutral, 22u);
  // What is nowhere true, and duplicates of what was asked for, stay wrong.
  PlanarMap est;
  est.planes = {gt.planes[0], gt.planes[0], square(7, {0, 0, 0.5}, {0, 0, 1}, 1.0)};
  est.planes[1].id = 9;
  EXPECT_EQ(comparePrimitives(gt, est).planes.precision(), 1.0 / 3.0);
}

TEST(ComparePrimitives, LinesBeyondTheSeenStretchOfASeamAreNeutral) {
  PlanarMap gt;
  const auto line = [](double from, double to) {
    PlanarMapLine result;
    result.planes = {0, 1};
    result.start.x() = from;
    result.end.x() = to;
    return result;
  };
  gt.lines = {line(0.0, 2.0)};
  gt.barely_seen.lines = {line(2.0, 4.0)};
  const auto tally = [&](double from, double to) {
    PlanarMap est;
    est.lines = {line(from, to)};
    return comparePrimitives(gt, est).lines;
  };
  EXPECT_EQ(tally(0.5, 3.0).est_correct, 1u);  // asked for, and longer than that
  EXPECT_EQ(tally(2.2, 3.5).est_neutral, 1u);
  EXPECT_EQ(tally(3.8, 5.0).precision(), 0.0);  // mostly where nothing is
  EXPECT_EQ(tally(1.7, 2.0).precision(), 0.0);  // a fragment of what was seen
}

TEST(ComparePrimitives, CornersOfAThinBoardAreNotDuplicatesOfEachOther) {
  // Its upper corner was asked for, the lower one was barely seen.
  PlanarMapCorner upper, lower;
  lower.position.z() = -0.02;
  PlanarMap gt, est;
  gt.corners = {upper};
  gt.barely_seen.corners = {lower};
  est.corners = {upper, lower};
  PrimitiveTally tally = comparePrimitives(gt, est).corners;
  EXPECT_EQ(tally.est_correct, 1U);
  EXPECT_EQ(tally.est_neutral, 1U);
  EXPECT_EQ(tally.precision(), 1.0);
  est.corners[1].position.z() = -0.005;  // rather the upper one
  tally = comparePrimitives(gt, est).corners;
  EXPECT_EQ(tally.est_neutral, 0U);
  EXPECT_EQ(tally.precision(), 0.5);
}

TEST(ComparePrimitives, RecallBySizeWeighsPlanesByPixelsAndLinesByMetres) {
  PlanarMap gt;
  gt.planes = {square(0, {0, 0, 0}, {0, 0, 1}, 1.0), square(1, {5, 0, 3}, {0, 0, 1}, 1.0)};
  gt.planes[0].points = 900;
  gt.planes[1].points = 100;
  gt.lines.resize(2);
  gt.lines[0].planes = {0, 1};
  gt.lines[0].end.x() = 3.0;
  gt.lines[1].planes = {0, 2};
  gt.lines[1].end.y() = 1.0;
  PlanarMap est;
  est.planes = {gt.planes[0]};
  est.lines = {gt.lines[1]};
  PrimitiveTallies tallies = comparePrimitives(gt, est);
  EXPECT_DOUBLE_EQ(*tallies.planes.recallBySize(), 0.9);
  EXPECT_DOUBLE_EQ(*tallies.lines.recallBySize(), 0.25);
  EXPECT_FALSE(tallies.corners.recallBySize());
  tallies.add(comparePrimitives(gt, gt));
  EXPECT_DOUBLE_EQ(*tallies.planes.recallBySize(), 0.95);
}

TEST(ComparePrimitives, ClaimsOfFragmentsAreChecked) {
  PlanarMap gt;
  const double tilt = degToRad(4.0);
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 2.0));
  gt.planes.push_back(square(1, {2, 0, 1}, {-std::cos(tilt), 0, std::sin(tilt)}, 1.0));
  PlanarMap est = gt;
  est.planes.push_back(est.planes[1]);  // a duplicate, which no true plane is matched to
  est.planes[2].id = 2;
  est.planes[2].orthogonal_to = {0};
  const OrthogonalityTally tally = comparePrimitives(gt, est).orthogonality;
  EXPECT_EQ(tally.checked, 1u);
  EXPECT_EQ(tally.wrong, 1u);
}

TEST(ComparePrimitives, SegmentsOfOnePairOfPlanesAreOneLine) {
  PlanarMap gt, est;
  const auto add = [](PlanarMap& map, double from, double to) {
    PlanarMapLine line;
    line.planes = {0, 1};
    line.start.x() = from;
    line.end.x() = to;
    map.lines.push_back(line);
  };
  add(gt, 0.0, 4.0);
  add(est, 3.0, 2.5);
  add(est, 0.0, 1.5);
  const PrimitiveTally lines = comparePrimitives(gt, est).lines;
  EXPECT_EQ(lines.est, 1u);
  EXPECT_EQ(lines.precision(), 1.0);
  EXPECT_EQ(lines.recall(), 1.0);
}

TEST(ComparePrimitives, LineErrorsAreMeasuredInTheMiddleOfTheSharedStretch) {
  PlanarMap gt, est;
  PlanarMapLine line;
  line.planes = {0, 1};
  line.end.x() = 4.0;
  gt.lines.push_back(line);
  // Rises from 0.01 to 0.02 over x from 2 to 4: at x = 3, the middle of what both share, 0.015.
  line.start = Eigen::Vector3d(2.0, 0.0, 0.01);
  line.end = Eigen::Vector3d(4.0, 0.0, 0.02);
  est.lines.push_back(line);
  const PrimitiveTally lines = comparePrimitives(gt, est).lines;
  ASSERT_EQ(lines.distances.size(), 1u);
  const double slope = std::atan2(0.01, 2.0);
  EXPECT_NEAR(lines.angles[0], slope, 1e-12);
  EXPECT_NEAR(lines.distances[0], 0.015 * std::cos(slope), 1e-12);
}

TEST(ComparePrimitives, CornerFramesAreEqualUpToTheir24Descriptions) {
  test::Random random(112);
  for (int k = 0; k < 100; ++k) {
    PlanarMap gt, est;
    PlanarMapCorner corner;
    corner.planes = {0, 1, 2};
    corner.position = random.vector(5.0);
    corner.orientation = Eigen::Quaterniond(random.rotation());
    gt.corners.push_back(corner);
    const double angle = random.uniform(0.0, degToRad(4.9));
    const Eigen::Quaterniond error(Eigen::AngleAxisd(angle, random.unitVector()));
    const double quarter = kPi / 2.0;
    const Eigen::Quaterniond redescribed =
        Eigen::AngleAxisd(quarter * random.integer(0, 3), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(quarter * random.integer(0, 3), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(quarter * random.integer(0, 3), Eigen::Vector3d::UnitZ());
    corner.orientation = error * corner.orientation * redescribed;
    est.corners.push_back(corner);
    const PrimitiveTally corners = comparePrimitives(gt, est).corners;
    ASSERT_EQ(corners.angles.size(), 1u);
    EXPECT_NEAR(corners.angles[0], angle, 1e-12);
  }
}

TEST(ComparePrimitives, CornersNearTheSensorAreSummarizedApart) {
  PlanarMap gt;
  gt.corners.resize(2);
  gt.corners[0].position = {2.4, 0, 0};
  gt.corners[1].position = {2.6, 0, 0};
  PlanarMap est = gt;
  est.corners[0].position.y() = 0.01;
  est.corners[1].position.y() = 0.05;
  EXPECT_TRUE(comparePrimitives(gt, est).corners.near_distances.empty());  // a map has no sensor
  gt.frame = "sensor";
  EXPECT_EQ(comparePrimitives(gt, est).corners.near_distances, std::vector<double>{0.01});
}

TEST(ComparePrimitives, EdgeBetweenPlanesThatAreNotOrthogonalIsFalse) {
  PlanarMap gt;
  const double tilt = degToRad(4.0);  // a wall at 86°
  gt.planes.push_back(square(0, {0, 0, 0}, {0, 0, 1}, 2.0));
  gt.planes.push_back(square(1, {2, 0, 1}, {-std::cos(tilt), 0, std::sin(tilt)}, 1.0));
  gt.planes.push_back(square(2, {0, 2, 1}, {0, -1, 0}, 1.0));
  PlanarMap est = gt;
  est.planes[0].orthogonal_to = {1, 2};
  est.planes[1].orthogonal_to = {0};
  est.planes[2].orthogonal_to = {0};
  est.planes.push_back(square(3, {9, 9, 9}, {1, 0, 0}, 1.0));
  est.planes[3].orthogonal_to = {0};
  const OrthogonalityTally tally = comparePrimitives(gt, est).orthogonality;
  EXPECT_EQ(tally.claimed, 3u);
  EXPECT_EQ(tally.checked, 2u);  // the plane that is none has no true angle
  EXPECT_EQ(tally.wrong, 1u);
  EXPECT_EQ(tally.falseRate(), 0.5);
}

TEST(ComparePrimitives, EmptyMapsHaveNoPrecisionOrRecall) {
  const PrimitiveTallies nothing = comparePrimitives({}, {});
  EXPECT_FALSE(nothing.planes.precision());
  EXPECT_FALSE(nothing.planes.recall());
  EXPECT_FALSE(nothing.orthogonality.falseRate());
  EXPECT_EQ(comparePrimitives(room(), {}).planes.recall(), 0.0);
  EXPECT_EQ(comparePrimitives({}, room()).corners.precision(), 0.0);
}

TEST(ComparePrimitives, TalliesAddUpOverMaps) {
  PrimitiveTallies sum = comparePrimitives(room(), room());
  sum.add(comparePrimitives(room(), {}));
  EXPECT_EQ(sum.maps, 2u);
  EXPECT_EQ(sum.planes.recall(), 0.5);
  EXPECT_EQ(sum.planes.precision(), 1.0);
  EXPECT_EQ(sum.lines.gt, 24u);
  EXPECT_EQ(sum.corners.distances.size(), 8u);
  EXPECT_EQ(sum.orthogonality.claimed, 12u);
}

TEST(ComparePrimitives, NoisyCopiesGiveErrorsOfThatSize) {
  test::Random random(113);
  for (int k = 0; k < 50; ++k) {
    PlanarMap est = room();
    for (PlanarMapPlane& plane : est.planes) {
      plane.plane =
          perturbed(plane.plane, {random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0.0});
      plane.plane = Plane::fromPointNormal(
          plane.centroid + random.uniform(-0.02, 0.02) * plane.plane.normal(),
          plane.plane.normal());
    }
    const PrimitiveTallies tallies = comparePrimitives(room(), est);
    EXPECT_EQ(tallies.planes.recall(), 1.0);
    EXPECT_LE(statisticsOf(tallies.planes.angles).max, 0.01 * std::sqrt(2.0));
    EXPECT_LE(statisticsOf(tallies.planes.distances).max, 0.02 + 1e-12);
  }
}

TEST(ComparePrimitives, RejectsBadParametersAndFrames) {
  PrimitiveErrorParams params;
  params.min_overlap = 1.5;
  EXPECT_THROW(comparePrimitives({}, {}, params), std::invalid_argument);
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(comparePrimitives({}, {}, {}, bad), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
