// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/build_polygons.h"

#include "planar/geos.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace opp::mapping {
namespace {

/// Runs of neighbouring cells of a row as rectangles, in units of cells: their corners are whole
/// numbers, on which all set operations of GEOS are exact.
std::vector<Geos::Geometry> runsOf(const std::vector<PlaneCell>& cells, const Geos& geos) {
  std::vector<Geos::Geometry> runs;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    end = begin + 1;
    while (end < cells.size() && cells[end].row == cells[begin].row &&
           cells[end].column == cells[end - 1].column + 1) {
      ++end;
    }
    const double low = cells[begin].row, left = cells[begin].column;
    const double high = low + 1.0, right = left + static_cast<double>(end - begin);
    runs.push_back(geos.polygon({{{left, low}, {right, low}, {right, high}, {left, high}}, {}}));
  }
  return runs;
}

/// Fills gaps of up to `widest` cells between neighbours in a row, then the same along columns.
std::vector<PlaneCell> closeGaps(std::vector<PlaneCell> cells, int widest) {
  for (int direction = 0; direction < 2; ++direction) {
    const std::size_t count = cells.size();
    for (std::size_t i = 1; i < count; ++i) {
      const PlaneCell before = cells[i - 1], after = cells[i];
      if (before.row != after.row || after.column - before.column - 1 > widest) continue;
      for (std::int32_t column = before.column + 1; column < after.column; ++column) {
        cells.push_back({before.row, column});
      }
    }
    for (PlaneCell& cell : cells) std::swap(cell.row, cell.column);
    std::sort(cells.begin(), cells.end());
  }
  return cells;
}

/// Number of cell centres inside of a ring; `cells` ascending. Scanline: a cell is inside if an odd
/// number of edges crosses its row to its left.
std::size_t cellsInside(const std::vector<PlaneCell>& cells, const Ring2d& ring) {
  double low = ring[0].y(), high = ring[0].y();
  for (const Eigen::Vector2d& vertex : ring) {
    low = std::min(low, vertex.y());
    high = std::max(high, vertex.y());
  }
  std::size_t count = 0;
  auto cell = std::lower_bound(cells.begin(), cells.end(),
                               PlaneCell{static_cast<std::int32_t>(std::floor(low)),
                                         std::numeric_limits<std::int32_t>::min()});
  for (; cell != cells.end() && cell->row <= high; ++cell) {
    const Eigen::Vector2d center(cell->column + 0.5, cell->row + 0.5);
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d& a = ring[i];
      const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
      if ((a.y() > center.y()) == (b.y() > center.y())) continue;
      const double x = a.x() + (center.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
      if (x < center.x()) inside = !inside;
    }
    if (inside) ++count;
  }
  return count;
}

/// Keeps the polygons and holes that are big enough, and of the holes those that are open.
std::vector<Polygon2d> select(std::vector<Polygon2d> polygons, const std::vector<PlaneCell>& open,
                              double min_cells, double open_fraction) {
  std::vector<Polygon2d> kept;
  for (Polygon2d& polygon : polygons) {
    if (signedArea(polygon.outer) < min_cells) continue;
    std::vector<Ring2d> holes;
    for (Ring2d& hole : polygon.holes) {
      const double area = -signedArea(hole);
      if (area < min_cells) continue;
      if (static_cast<double>(cellsInside(open, hole)) >= open_fraction * area) {
        holes.push_back(std::move(hole));
      }
    }
    polygon.holes = std::move(holes);
    kept.push_back(std::move(polygon));
  }
  return kept;
}

PlanarPolygon lift(const Polygon2d& polygon, const PlaneExtent& extent) {
  const auto lift_ring = [&](const Ring2d& ring) {
    std::vector<Eigen::Vector3d> vertices;
    for (const Eigen::Vector2d& vertex : ring) {
      vertices.push_back(extent.frame().lift(extent.cell() * vertex));
    }
    return vertices;
  };
  PlanarPolygon lifted{lift_ring(polygon.outer), {}};
  for (const Ring2d& hole : polygon.holes) lifted.holes.push_back(lift_ring(hole));
  return lifted;
}

double netArea(const Polygon2d& polygon) {
  double area = signedArea(polygon.outer);
  for (const Ring2d& hole : polygon.holes) area += signedArea(hole);
  return area;
}

/// Moments of a ring about the plane's normal: area vector · normal, and first moments.
void addRing(const std::vector<Eigen::Vector3d>& ring, const Eigen::Vector3d& normal, double& area,
             Eigen::Vector3d& moment) {
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const double triangle = 0.5 * (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]).dot(normal);
    area += triangle;
    moment += triangle / 3.0 * (ring[0] + ring[i] + ring[i + 1]);
  }
}

std::pair<double, Eigen::Vector3d> momentsOf(const std::vector<PlanarPolygon>& polygons,
                                             const Eigen::Vector3d& normal) {
  double area = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const PlanarPolygon& polygon : polygons) {
    addRing(polygon.outer, normal, area, moment);
    for (const auto& hole : polygon.holes) addRing(hole, normal, area, moment);
  }
  return {area, moment};
}

}  // namespace

std::vector<PlanarPolygon> buildPolygons(const PlaneExtent& extent, const PlanarParams& params) {
  const Geos geos;
  const double cell = extent.cell();
  const std::vector<PlaneCell> support =
      closeGaps(extent.supportCells(), static_cast<int>(params.bridge / cell));
  if (support.empty()) return {};
  const Geos::Geometry shape = geos.unionOf(geos.collection(runsOf(support, geos)));
  std::vector<Polygon2d> polygons = select(geos.polygonsOf(shape), extent.openCells(),
                                           params.min_area / (cell * cell), params.open_fraction);
  std::vector<Geos::Geometry> kept;
  for (const Polygon2d& polygon : polygons) kept.push_back(geos.polygon(polygon));
  if (kept.empty()) return {};
  polygons = geos.polygonsOf(
      geos.simplify(geos.collection(std::move(kept)), params.outline_tolerance / cell));
  std::stable_sort(polygons.begin(), polygons.end(),
                   [](const auto& a, const auto& b) { return netArea(a) > netArea(b); });
  std::vector<PlanarPolygon> lifted;
  for (const Polygon2d& polygon : polygons) lifted.push_back(lift(polygon, extent));
  return lifted;
}

double areaOf(const std::vector<PlanarPolygon>& polygons, const Eigen::Vector3d& normal) {
  return momentsOf(polygons, normal).first;
}

Eigen::Vector3d centroidOf(const std::vector<PlanarPolygon>& polygons,
                           const Eigen::Vector3d& normal) {
  const auto [area, moment] = momentsOf(polygons, normal);
  return area > 0.0 ? Eigen::Vector3d(moment / area) : Eigen::Vector3d::Zero();
}

}  // namespace opp::mapping
