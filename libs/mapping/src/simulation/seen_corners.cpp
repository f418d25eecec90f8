// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "seen_plane.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>

namespace opp::mapping {
namespace {

Eigen::Vector3d commonPoint(const SeenPlane& a, const SeenPlane& b, const SeenPlane& c) {
  Eigen::Matrix3d normals;
  normals << a.plane.normal().transpose(), b.plane.normal().transpose(),
      c.plane.normal().transpose();
  return normals.partialPivLu().solve(-Eigen::Vector3d(a.plane.d(), b.plane.d(), c.plane.d()));
}

bool touches(const Geos& geos, const SeenPlane& plane, const Eigen::Vector3d& point, double gap) {
  const auto h = geos.handle();
  const Eigen::Vector2d uv = plane.coordinates().uv(point);
  const auto place = geos.checked(GEOSGeom_createPointFromXY_r(h, uv.x(), uv.y()));
  double distance = 0.0;
  GEOSDistance_r(h, plane.outline.get(), place.get(), &distance);
  return distance <= gap;
}

std::uint64_t pixelsNear(const SeenPlane& plane, const Eigen::Vector3d& point, double reach) {
  std::uint64_t result = 0;
  for (const Coverage* coverage : plane.coverages) {
    coverage->forEachSeen([&](const Eigen::Vector3d& centre, std::uint32_t pixels) {
      if ((centre - point).norm() <= reach) result += pixels;
    });
  }
  return result;
}

/// Concave or convex where all three lines that meet here are; saddle where they differ; unknown
/// where one of them was not seen.
CornerKind kindOf(const std::array<int, 3>& ids, const Eigen::Vector3d& point,
                  const std::vector<SeenLine>& lines, double reach) {
  int concave = 0, convex = 0;
  for (const std::array<int, 2>& pair :
       {std::array<int, 2>{ids[0], ids[1]}, {ids[0], ids[2]}, {ids[1], ids[2]}}) {
    for (const SeenLine& line : lines) {
      if (line.planes != pair ||
          std::min((line.start - point).norm(), (line.end - point).norm()) > reach) {
        const Eigen::Vector3d along = (line.end - line.start).normalized();
        const double s = along.dot(point - line.start);
        const bool inside = s > 0.0 && s < (line.end - line.start).norm();
        if (line.planes != pair || !inside) continue;
      }
      ++(line.kind == LineKind::kConcave ? concave : convex);
      break;
    }
  }
  if (concave + convex < 3) return CornerKind::kUnknown;
  if (concave == 3) return CornerKind::kConcave;
  return convex == 3 ? CornerKind::kConvex : CornerKind::kSaddle;
}

/// min_pixels within reach of the point, a third of them on each of the planes.
bool enoughSeen(const std::array<const SeenPlane*, 3>& planes, const Eigen::Vector3d& point,
                const GroundTruthParams& params) {
  const auto enough = static_cast<std::uint64_t>(params.min_pixels);
  std::uint64_t total = 0;
  for (const SeenPlane* plane : planes) {
    if (isBarelySeen(*plane, params) || !plane->seenNear(point, params)) return false;
    const std::uint64_t pixels = pixelsNear(*plane, point, params.reach);
    if (3 * pixels < enough) return false;
    total += pixels;
  }
  return total >= enough;
}

/// Ascending ids of planes that pairwise have a seam.
std::vector<std::array<int, 3>> orthogonalTriples(const std::vector<Seam>& seams) {
  std::set<std::array<int, 2>> touching;
  for (const Seam& seam : seams) touching.insert(seam.planes);
  std::vector<std::array<int, 3>> result;
  for (const auto& [i, j] : touching) {
    for (auto next = touching.upper_bound({j, j}); next != touching.end() && (*next)[0] == j;
         ++next) {
      if (touching.count({i, (*next)[1]}) > 0) result.push_back({i, j, (*next)[1]});
    }
  }
  return result;
}

Eigen::Quaterniond orientationOf(const SeenPlane& a, const SeenPlane& b, const SeenPlane& c) {
  Eigen::Matrix3d axes;
  axes << a.plane.normal(), b.plane.normal(), c.plane.normal();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  return Eigen::Quaterniond(axes).normalized();
}

}  // namespace

SeenCorners seenCorners(const Geos& geos, const std::vector<SeenPlane>& planes,
                        const std::vector<Seam>& seams, const std::vector<SeenLine>& lines,
                        const GroundTruthParams& params) {
  SeenCorners result;
  for (const std::array<int, 3>& ids : orthogonalTriples(seams)) {
    const std::array<const SeenPlane*, 3> three{&planes[static_cast<std::size_t>(ids[0])],
                                                &planes[static_cast<std::size_t>(ids[1])],
                                                &planes[static_cast<std::size_t>(ids[2])]};
    const Eigen::Vector3d point = commonPoint(*three[0], *three[1], *three[2]);
    const auto meet = [&](double gap) {
      return std::all_of(three.begin(), three.end(),
                         [&](const SeenPlane* plane) { return touches(geos, *plane, point, gap); });
    };
    if (!meet(std::max(kTouch, params.near_gap))) continue;
    PlanarMapCorner corner;
    corner.planes = ids;
    corner.position = point;
    corner.orientation = orientationOf(*three[0], *three[1], *three[2]);
    if (meet(kTouch) && enoughSeen(three, point, params)) {
      corner.kind = kindOf(ids, point, lines, params.reach);
      result.corners.push_back(corner);
    } else {
      result.barely.push_back(corner);
    }
  }
  return result;
}

}  // namespace opp::mapping
