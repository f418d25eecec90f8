// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/ground_truth.h"

#include "coverage.h"

#include <Eigen/Geometry>

#include <map>
#include <vector>

namespace opp::mapping {

using SeenSides = std::map<int, Coverage>;  ///< by side of the world

/// Coplanar sides that make one plane of the truth.
struct SeenPlane {
  Plane plane;
  std::vector<int> sides;                  ///< seen ones, ascending
  std::vector<const Coverage*> coverages;  ///< of them
  Geos::Geometry outline;   ///< union of the whole faces, in the plane's own coordinates
  Eigen::AlignedBox3d box;  ///< of the whole faces [m]
  std::uint64_t pixels = 0;

  PlaneCoordinates coordinates() const { return PlaneCoordinates(plane); }
  bool seenNear(const Eigen::Vector3d& point) const;
};

/// Groups the seen sides into planes and drops those with too few pixels; in order of the smallest
/// side.
std::vector<SeenPlane> seenPlanes(const Geos& geos, const World& world, const SeenSides& sides,
                                  const GroundTruthParams& params);

/// The plane's faces clipped to what was seen.
std::vector<Polygon2d> seenPolygons(const Geos& geos, const SeenPlane& plane,
                                    const GroundTruthParams& params);

/// Pixels of a plane near a place, split by the side of another plane they lie on.
struct SplitCount {
  std::uint64_t positive = 0;
  std::uint64_t negative = 0;
  std::uint64_t total() const { return positive + negative; }
};

/// A seam of two orthogonal planes where both were seen.
struct SeenLine {
  std::array<int, 2> planes{};
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  LineKind kind = LineKind::kUnknown;
};

/// Pairs of orthogonal planes of which the whole faces touch along a line, ascending.
struct Seam {
  std::array<int, 2> planes{};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< point of both planes
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector
  std::vector<std::array<double, 2>> intervals;          ///< along it [m], ascending
};
std::vector<Seam> seams(const Geos& geos, const std::vector<SeenPlane>& planes);

std::vector<SeenLine> seenLines(const std::vector<SeenPlane>& planes,
                                const std::vector<Seam>& seams, const GroundTruthParams& params);

std::vector<PlanarMapCorner> seenCorners(const Geos& geos, const std::vector<SeenPlane>& planes,
                                         const std::vector<Seam>& seams,
                                         const std::vector<SeenLine>& lines,
                                         const GroundTruthParams& params);

}  // namespace opp::mapping
