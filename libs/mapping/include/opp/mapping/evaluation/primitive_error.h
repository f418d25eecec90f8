// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/evaluation/primitive_tally.h"
#include "opp/params/field.h"

#include <Eigen/Geometry>

#include <string_view>

namespace opp::mapping {

/// When an estimated plane, line or corner is the true one. The bounds say what is "the same thing,
/// measured badly" rather than "another thing"; how badly is what the errors tell.
struct PrimitiveErrorParams {
  static constexpr std::string_view kSection = "primitive_error";
  double max_angle = degToRad(5.0);
  double max_offset = 0.05;
  double max_distance = 0.06;
  double min_overlap = 0.5;
  double min_coverage = 0.25;
  double false_orthogonality = degToRad(2.0);
  double near_range = 2.5;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.max_angle,
      Field{"max_angle", "rad", 0.0, degToRad(45.0),
            "normals, directions and corner frames that differ more are not the same"});
    f(p.max_offset, Field{"max_offset", "m", 0.0, 10.0,
                          "planes farther apart at the true polygon's centroid are not the same"});
    f(p.max_distance,
      Field{"max_distance", "m", 0.0, 10.0, "lines and corners farther apart are not the same"});
    f(p.min_overlap, Field{"min_overlap", "", 0.0, 1.0,
                           "share of the smaller extent that must lie in the other one"});
    f(p.min_coverage,
      Field{"min_coverage", "", 0.0, 1.0, "share of the true extent that must be covered"});
    f(p.false_orthogonality,
      Field{"false_orthogonality", "rad", 0.0, degToRad(45.0),
            "true angles farther from 90 degrees make a claimed edge false"});
    f(p.near_range, Field{"near_range", "m", 0.0, 1000.0,
                          "in single scans, corners within this are summarized apart, too"});
  }
};

/// Compares estimated planes, lines and corners with the true ones.
///
/// Elements are the same if their geometry and their extents agree (PrimitiveErrorParams):
/// - planes: angle between normals, which point to the seen side, so that the two sides of a wall
///   are two planes; offset = distance of the estimated plane from the centroid of the true
///   polygons; overlap = area that the polygons share. An estimated plane without polygons must
///   have its centroid within `max_offset` of the true ones; a true one without is compared by
///   geometry alone.
/// - lines: one for each pair of planes, with all its segments. Angle between directions (without
///   sign); distance of the estimated line from the middle of the shared stretch; overlap = length
///   that the segments share along the true line.
/// - corners: distance of the positions; angle between the frames, of the 24 that describe the same
///   corner the nearest.
/// They are matched one to one: as many as possible, and of these ways the one of least cost (angle
/// and distance in units of their bounds, plus the part of the true extent that is not covered). A
/// true plane or line without a match is still found if it is the same as an estimated one that is
/// matched to a coplanar or collinear other (two table tops of equal height may share a plane).
///
/// An estimated element that is the same as none of these, but lies on one of
/// PlanarMap::barely_seen, counts neither as right nor as wrong: a plane by the rules above but for
/// min_coverage, a line with min_overlap of its length along the rest of a seam, a corner as above.
///
/// Orthogonality is claimed between planes by `orthogonal_to`, by lines and by corners. A claim is
/// checked if both planes are the same as true ones (matched, duplicate or barely seen), and false
/// if those are not orthogonal within `false_orthogonality`. \param gt_from_est brings the estimate
/// into the frame of the truth. \throws std::invalid_argument if a parameter is out of range or
/// gt_from_est is not finite.
PrimitiveTallies comparePrimitives(
    const PlanarMap& ground_truth, const PlanarMap& estimate,
    const PrimitiveErrorParams& params = {},
    const Eigen::Isometry3d& gt_from_est = Eigen::Isometry3d::Identity());

}  // namespace opp::mapping
