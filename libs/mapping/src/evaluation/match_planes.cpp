// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/polygon_overlap.h"

#include "evaluation/primitive_matching.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

/// Centroid of the polygons of a plane by area, holes left out; the plane's own centroid (of its
/// points) where there are no polygons.
Eigen::Vector3d polygonCentroid(const PlanarMapPlane& plane) {
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double area = 0.0;
  const Eigen::Vector3d& normal = plane.plane.normal();
  const auto add = [&](const std::vector<Eigen::Vector3d>& ring) {
    for (std::size_t k = 0; k + 2 < ring.size(); ++k) {
      const Eigen::Vector3d& a = ring[0];
      const Eigen::Vector3d& b = ring[k + 1];
      const Eigen::Vector3d& c = ring[k + 2];
      const double signed_area = 0.5 * normal.dot((b - a).cross(c - a));  // holes are negative
      weighted += signed_area * (a + b + c) / 3.0;
      area += signed_area;
    }
  };
  for (const PlanarPolygon& polygon : plane.polygons) {
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
  }
  return area > 0.0 ? Eigen::Vector3d(weighted / area) : plane.centroid;
}

struct Comparison {
  double angle = 0.0;   ///< [rad]
  double offset = 0.0;  ///< [m]
};

Comparison compare(const PlanarMapPlane& gt, const Eigen::Vector3d& gt_centroid, const Plane& est) {
  return {angleBetween(gt.plane, est), std::abs(est.signedDistance(gt_centroid))};
}

}  // namespace

PrimitiveMatching matchPlanes(const std::vector<PlanarMapPlane>& gt,
                              const std::vector<PlanarMapPlane>& est,
                              const PrimitiveErrorParams& params) {
  std::vector<Eigen::Vector3d> centroids;
  for (const PlanarMapPlane& plane : gt) centroids.push_back(polygonCentroid(plane));
  std::vector<PrimitiveCandidate> candidates;
  for (std::size_t g = 0; g < gt.size(); ++g) {
    const double gt_area = areaOf(gt[g].polygons);
    for (std::size_t e = 0; e < est.size(); ++e) {
      const Comparison difference = compare(gt[g], centroids[g], est[e].plane);
      if (difference.angle > params.max_angle || difference.offset > params.max_offset) continue;
      const double est_area = areaOf(est[e].polygons);
      const bool have_extents = gt_area > 0.0 && est_area > 0.0;
      const double shared =
          have_extents ? sharedArea(gt[g].plane, gt[g].polygons, est[e].polygons) : 0.0;
      if (have_extents && !extentsAgree(gt_area, est_area, shared, params)) continue;
      const double uncovered = have_extents ? 1.0 - std::min(1.0, shared / gt_area) : 0.0;
      candidates.push_back({g, e, difference.angle, difference.offset,
                            difference.angle / params.max_angle +
                                difference.offset / params.max_offset + uncovered});
    }
  }
  return matchPrimitives(gt.size(), est.size(), candidates, [&](std::size_t a, std::size_t b) {
    const Comparison difference = compare(gt[a], centroids[a], gt[b].plane);
    return difference.angle <= kSameAngle && difference.offset <= kSameDistance;
  });
}

}  // namespace opp::mapping
