// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "graph/plane_support.h"

#include "opp/graph/union_find.h"

#include "geometry/planar_spread.h"
#include "geometry/visit_neighbours.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace opp {
namespace {

/// A cell of the plane's grid; ordered row by row.
struct Cell {
  std::int64_t row, col;
  bool operator<(const Cell& other) const {
    return row != other.row ? row < other.row : col < other.col;
  }
  bool operator==(const Cell& other) const { return row == other.row && col == other.col; }
};

/// A sample in its cell.
struct Place {
  Cell cell;
  double x, y;  ///< in the plane [m]
};

Eigen::Vector3d pointOf(const OrientedCloud& cloud, int i) {
  return cloud.points[static_cast<std::size_t>(i)].cast<double>();
}

/// Coordinates along the common line, in units of `cell`, of the samples within `reach` of it:
/// sorted, each cell once.
std::vector<std::int64_t> cellsAlongLine(const OrientedCloud& cloud,
                                         const std::vector<int>& samples, const Plane& other,
                                         const Eigen::Vector3d& direction, double reach,
                                         double cell) {
  std::vector<std::int64_t> cells;
  for (const int i : samples) {
    const Eigen::Vector3d x = pointOf(cloud, i);
    if (std::abs(other.signedDistance(x)) > reach) continue;
    cells.push_back(static_cast<std::int64_t>(std::floor(direction.dot(x) / cell)));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Number of cells of `cells` that lie in or beside a cell of `others`: the spacing of samples is
/// not exactly regular.
std::size_t countNear(const std::vector<std::int64_t>& cells,
                      const std::vector<std::int64_t>& others) {
  std::size_t count = 0;
  auto other = others.begin();
  for (const std::int64_t cell : cells) {
    while (other != others.end() && *other < cell - 1) ++other;
    if (other != others.end() && *other <= cell + 1) ++count;
  }
  return count;
}

}  // namespace

SupportPatch leastSupport(const OrientedCloud& cloud, const GraphParams& params) {
  return cloud.extents.empty() ? SupportPatch{params.min_area, params.min_width}
                               : SupportPatch{params.detail_min_area, params.detail_min_width};
}

double meanExtent(const OrientedCloud& cloud, const std::vector<int>& samples) {
  double sum = 0.0;
  for (const int i : samples) sum += cloud.extent(static_cast<std::size_t>(i));
  return samples.empty() ? 0.0 : sum / static_cast<double>(samples.size());
}

SupportPatch largestPatch(const OrientedCloud& cloud, const Plane& plane,
                          const std::vector<int>& samples) {
  if (samples.empty()) return {};
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(plane.normal());
  const Eigen::Vector3d origin = pointOf(cloud, samples.front());
  const double extent = meanExtent(cloud, samples);
  // Samples without an extent all lie at one point.
  const double cells_per_metre = extent > 0.0 ? 0.5 / extent : 0.0;
  const auto indexOf = [&](double x) {
    return static_cast<std::int64_t>(std::floor(x * cells_per_metre));
  };
  std::vector<Place> places;
  places.reserve(samples.size());
  for (const int i : samples) {
    const Eigen::Vector3d step = pointOf(cloud, i) - origin;
    const double x = tangents.col(0).dot(step), y = tangents.col(1).dot(step);
    places.push_back({{indexOf(x), indexOf(y)}, x, y});
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.cell < b.cell; });
  std::vector<Cell> cells;
  for (const Place& place : places) {
    if (cells.empty() || !(cells.back() == place.cell)) cells.push_back(place.cell);
  }
  UnionFind sets(cells.size());
  visitNeighbours(cells, [&](std::size_t a, std::size_t b) { sets.join(a, b); });
  std::vector<PlanarSpread> spreads(cells.size());
  std::size_t cell = 0;
  for (const Place& place : places) {
    if (!(cells[cell] == place.cell)) ++cell;
    spreads[sets.root(cell)].add(place.x, place.y);
  }
  const auto largest =
      std::max_element(spreads.begin(), spreads.end(),
                       [](const auto& a, const auto& b) { return a.count() < b.count(); });
  return {largest->count(), largest->widths()[0] / extent};
}

double commonEdgeLength(const OrientedCloud& cloud, const EdgeSide& a, const EdgeSide& b,
                        double reach) {
  const Eigen::Vector3d cross = a.plane.normal().cross(b.plane.normal());
  if (cross.norm() < std::numeric_limits<double>::epsilon()) return 0.0;
  const Eigen::Vector3d direction = cross.normalized();
  const double cell = std::max(a.spacing, b.spacing);
  const auto cells_a =
      cellsAlongLine(cloud, a.samples, b.plane, direction, reach * a.spacing, cell);
  const auto cells_b =
      cellsAlongLine(cloud, b.samples, a.plane, direction, reach * b.spacing, cell);
  return static_cast<double>(std::min(countNear(cells_a, cells_b), countNear(cells_b, cells_a)));
}

bool meet(const OrientedCloud& cloud, const EdgeSide& a, const EdgeSide& b,
          const MeetingRule& rule) {
  const double cosine = a.plane.normal().dot(b.plane.normal());
  if (std::abs(cosine) > std::sin(rule.orthogonality)) return false;
  return commonEdgeLength(cloud, a, b, rule.reach) >= rule.min_length;
}

}  // namespace opp
