// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/polygon_overlap.h"

#include "evaluation/primitive_matching.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

/// The pair as candidate, if the planes are the same. \param centroid of the true polygons.
std::optional<PrimitiveCandidate> samePlane(const PlanarMapPlane& gt,
                                            const Eigen::Vector3d& centroid,
                                            const PlanarMapPlane& est,
                                            const PrimitiveErrorParams& params) {
  const Comparison difference = compare(gt, centroid, est.plane);
  if (difference.angle > params.max_angle || difference.offset > params.max_offset) return {};
  const double gt_area = areaOf(gt.polygons), est_area = areaOf(est.polygons);
  double uncovered = 0.0;
  if (gt_area > 0.0 && est_area > 0.0) {
    const double shared = sharedArea(gt.plane, gt.polygons, est.polygons);
    if (!extentsAgree(gt_area, est_area, shared, params)) return {};
    uncovered = 1.0 - std::min(1.0, shared / gt_area);
  } else if (gt_area > 0.0) {
    if (distanceTo(gt.plane, gt.polygons, est.centroid) > params.max_offset) return {};
    uncovered = 1.0;
  }
  return PrimitiveCandidate{
      0, 0, difference.angle, difference.offset,
      difference.angle / params.max_angle + difference.offset / params.max_offset + uncovered};
}

std::vector<Eigen::Vector3d> centroidsOf(const std::vector<PlanarMapPlane>& planes) {
  std::vector<Eigen::Vector3d> centroids;
  for (const PlanarMapPlane& plane : planes) centroids.push_back(polygonCentroid(plane));
  return centroids;
}

std::vector<PrimitiveCandidate> samePlanes(const std::vector<PlanarMapPlane>& gt,
                                           const std::vector<PlanarMapPlane>& est,
                                           const PrimitiveErrorParams& params) {
  const std::vector<Eigen::Vector3d> centroids = centroidsOf(gt);
  std::vector<PrimitiveCandidate> candidates;
  for (std::size_t g = 0; g < gt.size(); ++g) {
    for (std::size_t e = 0; e < est.size(); ++e) {
      auto candidate = samePlane(gt[g], centroids[g], est[e], params);
      if (!candidate) continue;
      candidate->gt = g;
      candidate->est = e;
      candidates.push_back(*candidate);
    }
  }
  return candidates;
}

}  // namespace

PlaneMatching matchPlanes(const PlanarMap& gt, const PlanarMap& est,
                          const PrimitiveErrorParams& params) {
  const std::vector<PrimitiveCandidate> same = samePlanes(gt.planes, est.planes, params);
  PrimitiveErrorParams any_coverage = params;
  any_coverage.min_coverage = 0.0;
  const auto barely_seen = samePlanes(gt.barely_seen.planes, est.planes, any_coverage);
  const std::vector<Eigen::Vector3d> centroids = centroidsOf(gt.planes);
  std::vector<double> pixels;
  for (const PlanarMapPlane& plane : gt.planes) pixels.push_back(static_cast<double>(plane.points));
  PlaneMatching matching;
  static_cast<PrimitiveMatching&>(matching) = matchPrimitives(
      pixels, est.planes.size(), same, barely_seen, [&](std::size_t a, std::size_t b) {
        const Comparison difference = compare(gt.planes[a], centroids[a], gt.planes[b].plane);
        return difference.angle <= kSameAngle && difference.offset <= kSameDistance;
      });
  matching.truth_of_est.assign(est.planes.size(), nullptr);
  for (const auto& c : barely_seen) matching.truth_of_est[c.est] = &gt.barely_seen.planes[c.gt];
  for (const auto& c : same) matching.truth_of_est[c.est] = &gt.planes[c.gt];
  for (std::size_t e = 0; e < est.planes.size(); ++e) {
    const int matched = matching.gt_of_est[e];
    if (matched >= 0) matching.truth_of_est[e] = &gt.planes[static_cast<std::size_t>(matched)];
  }
  return matching;
}

}  // namespace opp::mapping
