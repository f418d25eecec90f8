// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "seen_plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp::mapping {
namespace {

/// Coordinates of faces that were built to be coplanar differ by rounding only.
constexpr double kSamePlane = 1e-7;
constexpr double kSliver = 1e-6;  ///< polygons below are rounding where outlines meet [m²]

bool samePlane(const Plane& a, const Plane& b) {
  return (a.normal() - b.normal()).norm() < kSamePlane && std::abs(a.d() - b.d()) < kSamePlane;
}

const Face& faceOf(const World& world, int side) {
  return world.faces()[static_cast<std::size_t>(side / 2)];
}

/// Outline of a face in the coordinates of `plane`, which it lies on.
Geos::Geometry outlineOf(const Geos& geos, const World& world, int side, const Plane& plane) {
  Polygon2d polygon = PlaneCoordinates(plane).polygon(faceOf(world, side));
  return geos.polygon(polygon);
}

/// Index of the group of each side: coplanar sides connected by gaps of at most `join_gap`.
std::vector<std::size_t> groups(const Geos& geos, const World& world, const std::vector<int>& sides,
                                double join_gap) {
  std::vector<std::size_t> group(sides.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Plane plane = world.sidePlane(sides[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (group[i] == group[j] || !samePlane(plane, world.sidePlane(sides[j]))) continue;
      double gap = 0.0;
      GEOSDistance_r(geos.handle(), outlineOf(geos, world, sides[i], plane).get(),
                     outlineOf(geos, world, sides[j], plane).get(), &gap);
      if (gap > join_gap) continue;
      const std::size_t from = std::max(group[i], group[j]), to = std::min(group[i], group[j]);
      std::replace(group.begin(), group.end(), from, to);
    }
  }
  return group;
}

}  // namespace

bool SeenPlane::seenNear(const Eigen::Vector3d& point, const GroundTruthParams& params) const {
  const int radius = std::max(1, closingRadius(params));
  return std::any_of(coverages.begin(), coverages.end(),
                     [&](const Coverage* coverage) { return coverage->seenNear(point, radius); });
}

Eigen::Vector3d SeenPlane::someSeenPoint() const {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  coverages.front()->forEachSeen(
      [&](const Eigen::Vector3d& centre, std::uint32_t) { result = centre; });
  return result;
}

std::vector<SeenPlane> seenPlanes(const Geos& geos, const World& world, const SeenSides& sides,
                                  const GroundTruthParams& params) {
  std::vector<int> numbers;
  for (const auto& [side, coverage] : sides) numbers.push_back(side);
  const auto group = groups(geos, world, numbers, params.join_gap);
  std::vector<SeenPlane> result;
  for (std::size_t g = 0; g < numbers.size(); ++g) {
    SeenPlane plane;
    std::vector<Geos::Geometry> outlines;
    for (std::size_t i = g; i < numbers.size(); ++i) {
      if (group[i] != g) continue;
      if (plane.sides.empty()) plane.plane = world.sidePlane(numbers[i]);
      plane.sides.push_back(numbers[i]);
      plane.coverages.push_back(&sides.at(numbers[i]));
      plane.pixels += plane.coverages.back()->total();
      outlines.push_back(outlineOf(geos, world, numbers[i], plane.plane));
      for (const auto& vertex : faceOf(world, numbers[i]).outer) plane.box.extend(vertex);
    }
    if (plane.sides.empty()) continue;  // of an earlier group
    plane.outline = geos.unionOf(geos.collection(std::move(outlines)));
    result.push_back(std::move(plane));
  }
  std::stable_partition(result.begin(), result.end(),
                        [&](const SeenPlane& plane) { return !isBarelySeen(plane, params); });
  return result;
}

std::vector<Polygon2d> seenPolygons(const Geos& geos, const SeenPlane& plane,
                                    const GroundTruthParams& params) {
  Eigen::Vector2i low = plane.coverages[0]->firstCell(), high = plane.coverages[0]->lastCell();
  for (const Coverage* coverage : plane.coverages) {
    low = low.cwiseMin(coverage->firstCell());
    high = high.cwiseMax(coverage->lastCell());
  }
  CellMask mask(low, high);
  for (const Coverage* coverage : plane.coverages) coverage->addTo(mask);
  std::vector<Geos::Geometry> cells;
  for (const Polygon2d& run : mask.closed(closingRadius(params)).runs(params.cell)) {
    cells.push_back(geos.polygon(run));
  }
  const auto closed = geos.unionOf(geos.collection(std::move(cells)));
  const auto smooth = geos.simplify(closed, params.cell);
  const auto clipped =
      geos.checked(GEOSIntersection_r(geos.handle(), smooth.get(), plane.outline.get()));
  std::vector<Polygon2d> result = geos.polygonsOf(clipped);
  const auto sliver = [](const Polygon2d& polygon) { return signedArea(polygon.outer) < kSliver; };
  result.erase(std::remove_if(result.begin(), result.end(), sliver), result.end());
  return result;
}

}  // namespace opp::mapping
