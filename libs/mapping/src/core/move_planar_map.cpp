// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/move_planar_map.h"

namespace opp::mapping {
namespace {

void moveRing(const Eigen::Isometry3d& b_from_a, std::vector<Eigen::Vector3d>& ring) {
  for (Eigen::Vector3d& vertex : ring) vertex = b_from_a * vertex;
}

/// How a perturbation (α, β, δ) of a plane in frame a reads in frame b (see tangentBasis): the
/// tangent axes turn with the motion and are read in the basis of the new normal; d changes by
/// −Δn·t.
Eigen::Matrix3d perturbationJacobian(const Eigen::Isometry3d& b_from_a, const Plane& in_a,
                                     const Plane& in_b) {
  const Eigen::Matrix<double, 3, 2> turned = b_from_a.linear() * tangentBasis(in_a.normal());
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian.topLeftCorner<2, 2>() = tangentBasis(in_b.normal()).transpose() * turned;
  jacobian.bottomLeftCorner<1, 2>() = -b_from_a.translation().transpose() * turned;
  return jacobian;
}

void movePlane(const Eigen::Isometry3d& b_from_a, PlanarMapPlane& plane) {
  const Plane moved = transformed(b_from_a, plane.plane);
  const Eigen::Matrix3d jacobian = perturbationJacobian(b_from_a, plane.plane, moved);
  plane.plane = moved;
  plane.covariance = jacobian * plane.covariance * jacobian.transpose();
  plane.centroid = b_from_a * plane.centroid;
  for (PlanarPolygon& polygon : plane.polygons) {
    moveRing(b_from_a, polygon.outer);
    for (auto& hole : polygon.holes) moveRing(b_from_a, hole);
  }
}

/// Moves planes, lines and corners of a PlanarMap or its BarelySeen.
template <typename Elements>
void moveElements(const Eigen::Isometry3d& b_from_a, Elements& elements) {
  const Eigen::Quaterniond rotation(b_from_a.linear());
  for (PlanarMapPlane& plane : elements.planes) movePlane(b_from_a, plane);
  for (PlanarMapLine& line : elements.lines) {
    line.start = b_from_a * line.start;
    line.end = b_from_a * line.end;
  }
  for (PlanarMapCorner& corner : elements.corners) {
    corner.position = b_from_a * corner.position;
    corner.orientation = (rotation * corner.orientation).normalized();
    corner.covariance = b_from_a.linear() * corner.covariance * b_from_a.linear().transpose();
  }
}

}  // namespace

PlanarMap movedPlanarMap(const Eigen::Isometry3d& b_from_a, PlanarMap map_in_a) {
  PlanarMap map = std::move(map_in_a);
  moveElements(b_from_a, map);
  moveElements(b_from_a, map.barely_seen);
  for (PlanarMapFamily& family : map.families) family.normal = b_from_a.linear() * family.normal;
  return map;
}

}  // namespace opp::mapping
