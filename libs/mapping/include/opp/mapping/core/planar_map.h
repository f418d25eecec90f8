// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/primitives/primitives.h"

#include <Eigen/Geometry>

#include <array>
#include <string>
#include <vector>

namespace opp::mapping {

/// Simple polygon with holes on a plane. Rings do not repeat their first vertex; seen from the side
/// the plane's normal points to, the outer ring runs counter-clockwise and holes clockwise.
struct PlanarPolygon {
  std::vector<Eigen::Vector3d> outer;
  std::vector<std::vector<Eigen::Vector3d>> holes;
};

enum class PlaneKind { kOther, kFloor, kCeiling, kWall, kHorizontal, kVertical };

struct PlanarMapPlane {
  int id = 0;
  Plane plane;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  double area = 0.0;  ///< [m²]
  long points = 0;    ///< raw points (or pixels) that support it
  double rms = 0.0;   ///< [m]
  int family = -1;    ///< id of its family; −1: none
  PlaneKind kind = PlaneKind::kOther;
  std::vector<PlanarPolygon> polygons;
  std::vector<int> orthogonal_to;  ///< ids of planes it meets at a right angle, ascending
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (α, β, δ), see opp::tangentBasis
  std::vector<double> observations;  ///< timestamps of the scans that saw it [s]
};

struct PlanarMapFamily {
  int id = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  std::vector<int> planes;
};

struct PlanarMapLine {
  int id = 0;
  std::array<int, 2> planes{};
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  LineKind kind = LineKind::kUnknown;
};

struct PlanarMapCorner {
  int id = 0;
  std::array<int, 3> planes{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< frame_from_corner (LRF)
  CornerKind kind = CornerKind::kUnknown;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the position [m²]
  std::vector<double> observations;  ///< timestamps of the scans that saw it [s]
};

/// True elements of which too little was seen to ask anyone for them: planes and corners by too few
/// pixels, stretches of lines where one side was not seen at all. Simulated truth states them, so
/// that finding one counts neither as right nor as wrong.
struct BarelySeen {
  std::vector<PlanarMapPlane> planes;  ///< ids go on after those of PlanarMap::planes
  std::vector<PlanarMapLine> lines;    ///< of planes of either list, as corners
  std::vector<PlanarMapCorner> corners;

  bool empty() const { return planes.empty() && lines.empty() && corners.empty(); }
};

/// Planar abstraction of a scene or a scan: the contents of planar_map.json
/// (docs/planar_map.schema.json).
struct PlanarMap {
  std::string frame = "map";  ///< "map" or "sensor"
  std::vector<PlanarMapPlane> planes;
  std::vector<PlanarMapFamily> families;
  std::vector<PlanarMapLine> lines;
  std::vector<PlanarMapCorner> corners;
  BarelySeen barely_seen;
};

}  // namespace opp::mapping
