// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/ground_truth.h"

#include "coverage.h"

#include <Eigen/Geometry>

#include <cmath>
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
  /// Whether something within about `closing` of the point was seen: the gap between rows of
  /// pixels, or rings of a lidar, must not hide an edge.
  bool seenNear(const Eigen::Vector3d& point, const GroundTruthParams& params) const;
  Eigen::Vector3d someSeenPoint() const;  ///< centre of a seen cell
};

/// Groups the seen sides into planes: first those with `min_pixels`, then the barely seen ones,
/// both in order of their smallest side.
std::vector<SeenPlane> seenPlanes(const Geos& geos, const World& world, const SeenSides& sides,
                                  const GroundTruthParams& params);

/// `closing` in cells.
inline int closingRadius(const GroundTruthParams& params) {
  return static_cast<int>(std::lround(params.closing / params.cell));
}

inline bool isBarelySeen(const SeenPlane& plane, const GroundTruthParams& params) {
  return plane.pixels < static_cast<std::uint64_t>(params.min_pixels);
}

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

/// Faces nearer than this touch: far above rounding, far below any gap in a scene [m].
inline constexpr double kTouch = 1e-6;

/// Pair of orthogonal planes of which the whole faces touch, or nearly so, along a line.
struct Seam {
  std::array<int, 2> planes{};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< point of both planes
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector
  std::vector<std::array<double, 2>> intervals;          ///< along it [m], ascending
};

/// The seams of planes whose faces come as near as `gap` [m] to their common line, ascending.
std::vector<Seam> seams(const Geos& geos, const std::vector<SeenPlane>& planes, double gap);

/// Parts of the seams where enough was seen of both planes. Barely seen planes have none.
std::vector<SeenLine> seenLines(const std::vector<SeenPlane>& planes,
                                const std::vector<Seam>& seams, const GroundTruthParams& params);

/// What the lines leave of the seams, of unknown kind. Remains as short as a cell or the gap, by
/// which a seam reaches beyond its faces, are left out.
std::vector<SeenLine> restOfSeams(const std::vector<Seam>& seams,
                                  const std::vector<SeenLine>& lines,
                                  const GroundTruthParams& params);

/// Points where three orthogonal planes meet.
struct SeenCorners {
  std::vector<PlanarMapCorner> corners;  ///< they touch, and enough was seen of each there
  std::vector<PlanarMapCorner> barely;   ///< they come near, or less was seen; of unknown kind
};
/// \param seams of the planes, with gaps of up to near_gap.
SeenCorners seenCorners(const Geos& geos, const std::vector<SeenPlane>& planes,
                        const std::vector<Seam>& seams, const std::vector<SeenLine>& lines,
                        const GroundTruthParams& params);

}  // namespace opp::mapping
